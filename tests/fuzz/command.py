#!/usr/bin/env python3
"""Feeds whole files, damaged from good ones, to the command itself.

    tests/fuzz/command.py PELLICLE COUNT FOUND [--seed N] [--only I] [--jobs N]

Every file is read by one command, which must end within 20 seconds with exit code 0, 1 or 2; with 2
it has told why in one line and has left nothing behind. Files that break this are kept in the folder
FOUND with what was run and seen, and the exit code is 1. File number I of a seed is always the same.
"""
import argparse
import concurrent.futures
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile

from command_damage import damaged
from command_meshes import meshes
from command_volumes import NOT_READ, Packed, nrrd_header, raw, volumes

SECONDS = 20
ADDRESS_SPACE = 8 << 30
WARNINGS = ['series; the largest is read', 'left out']  # told before what may still be refused
ATTACH = b'# held\npin 0 0 12 2\nattach 3 0 13 2 0.5\nattach 0.5 0 16 1\n'
GOOD = {'good.nrrd': nrrd_header('short', 'raw') + raw('h')}
EXTRACT = ['extract', 'good.nrrd', '-o', 'out/a.ply', '--iso', '100', '--max-iterations', '3']


def of_volume(path):
    extract = ['-o', 'out/a.ply', '--max-iterations', '3']
    return [['extract', path, '--iso', '100', *extract], ['info', path],
            ['extract', path, '--iso', '100', '--levels', '0', '--report', 'out/a.json', *extract],
            ['extract', '--labels', path, *extract],
            [*EXTRACT, '--init', f'mask={path}']]


def of_mesh(path):
    return [['check', path], ['check', path, '--json'], ['info', path],
            ['mesh', path, '-o', 'out/a.vtk', '--keep', 'largest'],
            ['mesh', path, '-o', 'out/a.glb'],
            ['measure', path, '--curvature', '--geodesic', '0,0,0', '-o', 'out/a.vtp', '--json',
             'out/a.json'],
            ['measure', path, '--distance', path],
            ['render', path, '--size', '32', '-o', 'out/a.png'],
            [*EXTRACT, '--init', f'mesh={path}']]


def all_cases():
    """Name, files, and the commands that read them."""
    for name, files, path in volumes():
        yield name, files, of_volume(path)
    for name, files, path in meshes():
        yield name, files, of_mesh(path)
    yield 'places', {'a.txt': ATTACH}, [[*EXTRACT, '--attach', 'a.txt']]


CASES = list(all_cases())


def contents(file):
    return file.pack(file.inside) if isinstance(file, Packed) else file


def made(seed, index):
    """The files and the command of one number; every 50th is left as it is."""
    rng = random.Random(f'{seed} {index}')
    name, files, commands = rng.choice(CASES)
    whole = name not in NOT_READ and rng.randrange(50) == 0
    hit = rng.choice(list(files))
    out = dict(GOOD)
    for path, file in files.items():
        if path != hit or whole:
            out[path] = contents(file)
        elif isinstance(file, Packed) and rng.random() < 0.6:
            out[path] = file.pack(damaged(rng, file.inside))
        else:
            out[path] = damaged(rng, contents(file))
    return name, out, rng.choice(commands), whole


def wrong_with(code, lines, left, whole, group_lives):
    """What the command has done wrong, or None."""
    if code is None:
        return f'does not end within {SECONDS} s'
    if code < 0:
        return f'ends by {signal.Signals(-code).name}'
    if code not in (0, 1, 2):
        return f'exit code {code}'
    if not all(line.startswith('pellicle: ') for line in lines):
        return 'a line on stderr that is not its own'
    warnings = [line for line in lines if any(words in line for words in WARNINGS)]
    if code == 2 and len(lines) != len(warnings) + 1:
        return f'exit code 2 and {len(lines)} lines on stderr'
    if code == 2 and left:
        return 'refused, but leaves ' + ' '.join(left)
    if any('.pellicle-' in name for name in left):
        return 'leaves a temporary file'
    if any('internal error' in line for line in lines):
        return 'an internal error'
    if code == 2 and whole:
        return 'refuses a good file'
    if group_lives:
        return 'leaves a process behind'
    return None


def lives(group):
    try:
        os.killpg(group, signal.SIGKILL)
        return True
    except ProcessLookupError:
        return False


def run(pellicle, folder, command):
    """Exit code, None where it does not end, and stderr."""
    limited = ['prlimit', f'--as={ADDRESS_SPACE}', pellicle, *command]
    with open(folder / 'stderr', 'wb') as errors:
        process = subprocess.Popen(limited, cwd=folder, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=errors, start_new_session=True)
        try:
            code = process.wait(SECONDS)
        except subprocess.TimeoutExpired:
            code = None
        group_lives = lives(process.pid)
        process.wait()
    return code, (folder / 'stderr').read_text(errors='replace'), group_lives


def try_one(options, index):
    name, files, command, whole = made(options.seed, index)
    with tempfile.TemporaryDirectory(prefix='pellicle-fuzz-') as scratch:
        folder = pathlib.Path(scratch)
        (folder / 'out').mkdir()
        for path, data in files.items():
            (folder / path).parent.mkdir(exist_ok=True)
            (folder / path).write_bytes(data)
        code, told, group_lives = run(options.pellicle, folder, command)
        left = sorted(path.name for path in (folder / 'out').iterdir())
        wrong = wrong_with(code, told.splitlines(), left, whole, group_lives)
        if wrong is not None:
            kept = pathlib.Path(options.found) / f'{options.seed}-{index}-{name}'
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
            (kept / 'command').write_text(' '.join(['pellicle', *command]) + f'\n{wrong}\n')
            print(f'{kept}: pellicle {" ".join(command)}: {wrong}', flush=True)
        return code, wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('pellicle', type=os.path.abspath)
    parser.add_argument('count', type=int)
    parser.add_argument('found')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--only', type=int)
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    options = parser.parse_args()
    indices = range(options.count) if options.only is None else [options.only]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(lambda index: try_one(options, index), indices))
    refused = sum(code == 2 for code, _ in results)
    read = sum(code in (0, 1) for code, _ in results)
    findings = sum(wrong is not None for _, wrong in results)
    print(f'{"command":<13} {len(results):>9} files  {refused:>6} refused, {read} read  '
          f'{findings} findings')
    return 1 if findings else 0


if __name__ == '__main__':
    sys.exit(main())
