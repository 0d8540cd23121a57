#!/usr/bin/env python3
"""Random images and options for the command, as nobody would choose them:

  campaign_command.py PELLICLE [N] [--from SEED] [--jobs J] [--timeout SECONDS] [--keep FOLDER]

Each case is an image (noise of all scales, thin plates, rods, checkerboards, plateaus at the
iso-value, balls, ramps; 2 x 2 x 2 voxels and more, of 0.01 to 100 mm) and options drawn over their
ranges. Demanded of each run: it ends by itself within SECONDS (120) of processor time, with exit code
0 and a surface that `pellicle check` calls valid, or with exit code 2, one line on stderr and no
file left. What does not is kept in FOLDER as SEED.nrrd and SEED.txt, and makes the exit code 1.
"""
import argparse
import concurrent.futures
import math
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile

import numpy

TYPES = {"uint8": numpy.uint8, "int16": numpy.int16, "uint16": numpy.uint16,
         "int32": numpy.int32, "float": numpy.float32}


def log_uniform(draw, low, high):
    return math.exp(draw.uniform(math.log(low), math.log(high)))


def choose_dims(draw):
    kind = draw.randrange(6)
    if kind == 0:
        return [draw.randint(2, 5) for _ in range(3)]
    if kind == 1:
        dims = [draw.randint(2, 4), draw.randint(2, 4), draw.randint(50, 300)]
        draw.shuffle(dims)
        return dims
    return [draw.randint(6, 36) for _ in range(3)]


def choose_spacing(draw):
    kind = draw.randrange(5)
    if kind < 2:
        return [1.0, 1.0, 1.0]
    if kind == 2:
        return [log_uniform(draw, 0.01, 100)] * 3
    return [log_uniform(draw, 0.01, 100) for _ in range(3)]


def smoothed(field, passes):
    for _ in range(passes):
        for axis in range(3):
            field = (numpy.roll(field, 1, axis) + 2 * field + numpy.roll(field, -1, axis)) / 4
    return field


def choose_field(draw, dims):
    """Values of about 0 to 1, indexed z, y, x."""
    rng = numpy.random.Generator(numpy.random.PCG64(draw.getrandbits(63)))
    shape = dims[::-1]
    z, y, x = numpy.meshgrid(*[numpy.arange(n, dtype=float) for n in shape], indexing="ij")
    normal = numpy.array([draw.gauss(0, 1) for _ in range(3)])
    normal /= numpy.linalg.norm(normal) + 1e-9
    if draw.random() < 0.3:
        normal = numpy.eye(3)[draw.randrange(3)]
    middle = [(n - 1) / 2 * draw.uniform(0.6, 1.4) for n in dims]
    px, py, pz = x - middle[0], y - middle[1], z - middle[2]
    along = px * normal[0] + py * normal[1] + pz * normal[2]
    across = numpy.sqrt(numpy.maximum(px**2 + py**2 + pz**2 - along**2, 0))
    width = draw.uniform(0.3, 3)
    kind = draw.choice(["white", "smooth", "plate", "rod", "checker", "plateau", "ball", "ramp",
                        "plates", "specks"])
    if kind == "white":
        field = rng.random(shape)
    elif kind == "smooth":
        field = smoothed(rng.random(shape), draw.randint(1, 12))
        field = (field - field.min()) / (numpy.ptp(field) or 1)
    elif kind == "plate":
        field = numpy.clip(0.5 + width / 2 - abs(along), 0, 1)
    elif kind == "plates":
        field = numpy.clip(0.5 + width / 2 - abs((along % (2 * width + 1)) - width), 0, 1)
    elif kind == "rod":
        field = numpy.clip(0.5 + width / 2 - across, 0, 1)
    elif kind == "checker":
        cell = draw.randint(1, 4)
        field = ((x // cell + y // cell + z // cell) % 2)
    elif kind == "plateau":
        steps = draw.randint(2, 6)
        field = numpy.floor(smoothed(rng.random(shape), draw.randint(0, 5)) * steps) / (steps - 1)
    elif kind == "ball":
        radius = draw.uniform(0.1, 0.8) * min(dims)
        field = numpy.clip(0.5 + radius - numpy.sqrt(px**2 + py**2 + pz**2), 0, 1)
    elif kind == "ramp":
        field = (along - along.min()) / (numpy.ptp(along) or 1)
    else:
        field = (rng.random(shape) < draw.uniform(0.002, 0.3)).astype(float)
    if draw.random() < 0.3:
        field = field + log_uniform(draw, 0.001, 1) * rng.standard_normal(shape)
    return kind, field


def write_image(draw, path):
    """Returns what it is, its values from the lowest to the highest, and its finest spacing."""
    dims, spacing = choose_dims(draw), choose_spacing(draw)
    kind, field = choose_field(draw, dims)
    name = draw.choice(list(TYPES))
    scale, offset = log_uniform(draw, 1e-3, 1e4), draw.choice([0, 0, -1000, 1e3])
    if name != "float":
        scale = draw.choice([1, 5, 100, 250])
        offset = 0 if name == "uint8" else max(offset, -1000 if name[0] == "i" else 0)
        limits = numpy.iinfo(TYPES[name])
        values = numpy.clip(numpy.round(field * scale + offset), limits.min, limits.max)
    else:
        values = field * scale + offset
    values = numpy.ascontiguousarray(values.astype(TYPES[name]))
    axes = numpy.eye(3)
    if draw.random() < 0.4:
        axes, _ = numpy.linalg.qr(numpy.array([[draw.gauss(0, 1) for _ in range(3)] for _ in range(3)]))
    vectors = " ".join("(%.17g,%.17g,%.17g)" % tuple(axes[:, a] * spacing[a]) for a in range(3))
    header = (f"NRRD0004\ntype: {name}\ndimension: 3\nspace: left-posterior-superior\n"
              f"sizes: {dims[0]} {dims[1]} {dims[2]}\nspace directions: {vectors}\n"
              f"endian: little\nencoding: raw\nspace origin: ({draw.uniform(-1e3, 1e3)},"
              f"{draw.uniform(-1e3, 1e3)},{draw.uniform(-1e3, 1e3)})\n\n")
    with open(path, "wb") as file:
        file.write(header.encode() + values.tobytes())
    return (f"{kind} {name} {dims} spacing {spacing}", numpy.sort(values.astype(float).ravel()),
            min(spacing))


def choose_options(draw, values, finest):
    def value(part):
        return float(values[int(part * (len(values) - 1))])

    part = draw.choice([0.5, draw.uniform(0.02, 0.98)])
    iso = draw.choice([value(part), (values[0] + values[-1]) / 2, value(part) + 1e-6])
    width = float(values[-1] - values[0]) or 1.0
    if draw.random() < 0.95:
        iso = min(max(iso, values[0] + 1e-3 * width), values[-1] - 1e-3 * width)
    options = ["--iso", f"{iso:.9g}"]

    def maybe(chance, *texts):
        if draw.random() < chance:
            options.extend(texts)

    maybe(0.3, "--inside", "below")
    maybe(0.15, f"--window={iso - draw.uniform(0.01, 2) * width:.9g},{iso + draw.uniform(0.01, 2) * width:.9g}")
    maybe(0.1, f"--pad={iso + draw.uniform(-1, 1) * width:.9g}")
    maybe(0.1, "--feature", "gradient-norm", "--sigma", f"{finest * log_uniform(draw, 0.1, 4):.6g}")
    maybe(0.4, "--levels", str(draw.choice([0, 1, 1, 2, 2, 3, 4])))
    maybe(0.3, "--reduction", f"{draw.uniform(1.05, 2):.9g}")
    maybe(0.5, "--anisotropy", draw.choice(["physical", "voxel", "metric"]))
    maybe(0.4, "--init", draw.choice(["iso", "iso", "bubbles=2,1,1", "bubbles=2,2,2", "bubble"]))
    maybe(0.4, "--curvature", draw.choice(["0", "0.05", "0.1", "1", "7.5"]))
    maybe(0.3, "--spring", draw.choice(["0.001", "0.01", "0.1", "1"]))
    maybe(0.3, "--rest-length", draw.choice(["zero", "mean", "1", "1.5", "2.5"]))
    maybe(0.2, "--force", draw.choice(["gradient", "both"]))
    maybe(0.3, "--attraction", f"{log_uniform(draw, 0.01, 10):.4g}")
    maybe(0.2, f"--gradient={draw.uniform(-2, 2):.4g}")
    maybe(0.2, f"--gradient-tangent={draw.uniform(-2, 2):.4g}")
    maybe(0.1, "--gradient-bound", f"{log_uniform(draw, 1e-3, 10):.4g}")
    maybe(0.2, "--mass", f"{log_uniform(draw, 0.1, 10):.4g}")
    maybe(0.2, "--damping", draw.choice(["0", "0.1", "1", "3", "10"]))
    maybe(0.2, "--time-step", f"{log_uniform(draw, 0.1, 10):.4g}")
    maybe(0.2, "--max-move", f"{draw.uniform(0.05, 1):.4g}")
    maybe(0.2, "--bound", "scale")
    maybe(0.2, "--epsilon", f"{log_uniform(draw, 1e-6, 1e-2):.4g}")
    maybe(0.1, "--calm-speed", f"{log_uniform(draw, 1e-3, 1):.4g}")
    maybe(0.2, "--max-iterations", draw.choice(["1", "50", "200"]))
    for flag in ("--no-late-bubbles", "--no-sleeping", "--each-level"):
        maybe(0.1, flag)
    maybe(0.3, "--space", draw.choice(["ras", "voxel"]))
    if draw.random() < 0.4:
        options += ["--mesh", "adaptive"]
        maybe(0.4, "--tolerance", f"{finest * log_uniform(draw, 1e-3, 1):.6g}")
        maybe(0.4, f"--edge-range={finest * log_uniform(draw, 0.2, 1):.6g},{finest * log_uniform(draw, 1, 9):.6g}")
    return options


def limits(seconds):
    def set_limits():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return set_limits


def run_case(pellicle, seed, seconds, keep):
    """Returns (what is wrong or "", "surface" or "refused", line of the refusal, seconds)."""
    draw = random.Random(seed)
    folder = tempfile.mkdtemp(prefix="pellicle-campaign-")
    image = os.path.join(folder, "image.nrrd")
    out = os.path.join(folder, "out")
    os.mkdir(out)
    surface = os.path.join(out, "surface" + draw.choice([".ply", ".stl", ".obj", ".vtp", ".off"]))
    what, values, finest = write_image(draw, image)
    options = choose_options(draw, values, finest)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        # A process that loops has spent its processor time long before this.
        run = subprocess.run([pellicle, "extract", image, "-o", surface, "--quiet", "--threads", "1", *options],
                             capture_output=True, timeout=20 * seconds, check=False,
                             preexec_fn=limits(seconds))
        code, error = run.returncode, run.stderr.decode(errors="replace")
    except subprocess.TimeoutExpired:
        code, error = -1000, ""
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    lines = error.splitlines()
    wrong, end = "", "surface"
    if code in (-9, -24, -1000):
        wrong = f"takes more than {seconds} s"
    elif code == 2:
        end = "refused"
        if len(lines) != 1 or not lines[0].startswith("pellicle: "):
            wrong = f"refused by {len(lines)} lines: {error[:300]}"
        elif "internal error" in error:
            wrong = error
        elif os.listdir(out) and "--each-level" not in options:
            wrong = f"refused, but leaves {os.listdir(out)}"
    elif code != 0:
        wrong = f"exit code {code}: {error[:300]}"
    else:
        check = subprocess.run([pellicle, "check", surface], capture_output=True, check=False)
        if check.returncode != 0:
            wrong = "not valid: " + check.stdout.decode(errors="replace")[:600]
    if wrong and keep:
        os.makedirs(keep, exist_ok=True)
        shutil.copy(image, os.path.join(keep, f"{seed}.nrrd"))
        with open(os.path.join(keep, f"{seed}.txt"), "w", encoding="utf-8") as file:
            file.write(f"{what}\n{' '.join(options)}\n{wrong}\n")
    shutil.rmtree(folder)
    return wrong, end, lines[0] if lines else "", spent, f"{what} {' '.join(options)}"


def reason_of(line):
    return "".join("#" if c.isdigit() else c for c in line.split(": ", 1)[-1])[:70]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pellicle")
    parser.add_argument("count", nargs="?", type=int, default=2000)
    parser.add_argument("--from", dest="first", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--timeout", type=int, default=120)
    parser.add_argument("--keep", default="")
    options = parser.parse_args()
    if not shutil.which(options.pellicle):
        parser.error(f"{options.pellicle}: cannot be run")
    surfaces = refused = findings = 0
    slowest = []
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        seeds = range(options.first, options.first + options.count)
        cases = pool.map(run_case, [options.pellicle] * len(seeds), seeds,
                         [options.timeout] * len(seeds), [options.keep] * len(seeds))
        for seed, (wrong, end, line, spent, what) in zip(seeds, cases):
            surfaces += end == "surface" and not wrong
            refused += end == "refused" and not wrong
            slowest = sorted([*slowest, (spent, seed)])[-5:]
            if wrong:
                findings += 1
                print(f"seed {seed}: {wrong.strip()}\n  {what}", flush=True)
            elif end == "refused" and os.environ.get("PELLICLE_CAMPAIGN_REPORT"):
                print(f"seed {seed}: {line}", flush=True)
    told = ", ".join(f"{seed} ({spent:.1f} s)" for spent, seed in reversed(slowest))
    print(f"{surfaces + refused + findings} cases: {surfaces} surfaces, {refused} refused, {findings} findings; slowest {told}")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
