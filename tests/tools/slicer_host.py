"""3D Slicer as `pellicle extract` meets it: reads the description that --xml prints with the rules of
Slicer's own parser, builds the command line as Slicer does from its parameters, and follows the
progress on stdout.   tests/tools/slicer_host.py PELLICLE FOLDER
"""
import filecmp
import os
import re
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

PELLICLE, FOLDER = sys.argv[1], sys.argv[2]
EXTRACT = [PELLICLE, "extract"]
ISO = {"iso": "0.5"}

ATTRIBUTES = {"image": {"type"}, "geometry": {"type", "fileExtensions"}, "boolean": {"hidden"},
              "file": {"fileExtensions"}}
NUMBERS = {"integer", "double"}
TAGS = NUMBERS | {"image", "geometry", "file", "boolean", "string", "string-enumeration"}
CHILDREN = {"name", "longflag", "label", "description", "default", "index", "channel", "element",
            "constraints"}
VARIABLE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
PROGRESS = re.compile(r"<filter-progress>(.*?)</filter-progress>")
failures = 0


def expect(condition, what):
    global failures
    if not condition:
        print("FAILED:", what)
        failures += 1
    return condition


def text(parameter, name):
    return parameter.findtext(name, "").strip()


def read_description(option):
    done = subprocess.run(EXTRACT + [option], capture_output=True, text=True)
    expect(done.returncode == 0 and done.stderr == "", "--xml: fails, or writes to stderr")
    expect(done.stdout.startswith("<?xml"), "--xml: something stands before the XML")
    root = ElementTree.fromstring(done.stdout)
    expect(root.tag == "executable", "--xml: the outermost element is " + root.tag)
    for name in ("category", "title", "description", "version"):
        expect(text(root, name), "--xml: no " + name)
    parameters = []
    for group in root.findall("parameters"):
        expect(set(group.attrib) <= {"advanced"}, "attributes of a group of parameters")
        expect(text(group, "label"), "a group without a label")
        parameters += [p for p in group if p.tag not in ("label", "description")]
    return parameters


def check_number(parameter, name):
    """The default must come through the spin box that Slicer makes of it, and through %g."""
    default = text(parameter, "default")
    if not expect(re.fullmatch(r"-?\d+(\.\d+)?", default), f"{name}: default '{default}'"):
        return
    expect(float(f"{float(default):g}") == float(default), f"{name}: too many digits")
    limits = parameter.find("constraints")
    if limits is not None:
        low, high = (float(text(limits, end)) for end in ("minimum", "maximum"))
        expect(low <= float(default) <= high, f"{name}: the default is not on the slider")
        expect(float(text(limits, "step")) > 0, f"{name}: the slider does not move")


def check_parameters(parameters):
    names = [text(p, "name") for p in parameters]
    expect(len(set(names)) == len(names), "two parameters of one name")
    for parameter, name in zip(parameters, names):
        expect(parameter.tag in TAGS, f"{name}: {parameter.tag} is no type of Slicer")
        expect(set(parameter.attrib) <= ATTRIBUTES.get(parameter.tag, set()),
               f"{name}: attributes {parameter.attrib}")
        expect({child.tag for child in parameter} <= CHILDREN, f"{name}: unknown elements")
        expect(VARIABLE.match(name), f"{name}: not a name to Slicer")
        expect((parameter.find("longflag") is None) != (parameter.find("index") is None),
               f"{name}: needs one of longflag and index")
        if parameter.find("longflag") is not None:
            expect(VARIABLE.match(text(parameter, "longflag")), f"{name}: not a flag to Slicer")
        expect(text(parameter, "label") and text(parameter, "description"), f"{name}: not described")
        if parameter.tag in NUMBERS:
            check_number(parameter, name)
        if parameter.tag == "string-enumeration":
            elements = [e.text for e in parameter.findall("element")]
            expect(text(parameter, "default") in elements, f"{name}: default not one of {elements}")
    channels = {text(p, "channel"): p.tag for p in parameters
                if p.find("channel") is not None and p.tag != "file"}
    expect(channels == {"input": "image", "output": "geometry"}, f"channels {channels}")
    expect("space" not in names, "Slicer takes a mesh without a space for LPS: no other may be chosen")


def command_line(parameters, image, mesh, values):
    """As vtkSlicerCLIModuleLogic makes it; values: what the user has changed."""
    line, last = list(EXTRACT), []
    for parameter in parameters:
        name = text(parameter, "name")
        value = values.get(name, text(parameter, "default"))
        flag = "--" + text(parameter, "longflag")
        if parameter.tag == "image" and parameter.find("index") is not None:
            last.append(image)
        elif parameter.tag == "image":
            line += [flag, image]
        elif parameter.tag == "file":
            line += [flag, value] if value else []
        elif parameter.tag == "geometry":
            line += [flag, mesh]
        elif parameter.tag == "boolean":
            line += [flag] if value == "true" else []
        elif parameter.tag == "string":
            line += [flag, value] if value else []
        else:
            line += [flag, value]
    return line + last


def run(*arguments):
    return subprocess.run(arguments, capture_output=True, text=True)


def check_run(parameters):
    """All defaults, as Slicer passes them, are those of the command; progress goes from 0 to 1."""
    image, mesh, plain = (f"{FOLDER}/{name}" for name in ("blobs.nrrd", "slicer.vtp", "plain.vtp"))
    run(PELLICLE, "phantom", "blobs", "--size", "100", "--seed", "7", "-o", image)
    done = run(*command_line(parameters, image, mesh, ISO))
    expect(done.returncode == 0, f"as Slicer runs it: {done.returncode}, {done.stderr}")
    expect(done.stderr == "", "as Slicer runs it: writes to stderr")
    told = [float(f) for f in PROGRESS.findall(done.stdout)]
    expect(len(told) > 2 and told[0] == 0 and told[-1] == 1, f"progress {told}")
    expect(told == sorted(told), f"progress falls: {told}")
    for element in ("<filter-start>", "<filter-comment>", "</filter-end>"):
        expect(element in done.stdout, "no " + element)
    expect(done.stdout.rstrip().endswith("</filter-end>"), "something after the end")
    expect(run(PELLICLE, "check", mesh).returncode == 0, "the mesh is not valid")
    run(PELLICLE, "extract", image, "--iso", "0.5", "-o", plain)
    expect(filecmp.cmp(mesh, plain, False), "with Slicer's defaults another surface comes out")


def check_values(parameters):
    """Whatever can be chosen is taken."""
    for parameter in parameters:
        name = text(parameter, "name")
        choices = [e.text for e in parameter.findall("element")]
        if parameter.tag == "boolean":
            choices = ["true", "false"]
        for choice in choices:
            line = command_line(parameters, "missing.nrrd", f"{FOLDER}/none.vtp",
                                {**ISO, name: choice})
            done = run(*line)
            expect(done.returncode == 2 and ("missing.nrrd" in done.stderr or name == "simd"),
                   f"{name} {choice}: {done.stderr}")
    image, mesh = f"{FOLDER}/small.nrrd", f"{FOLDER}/small.vtp"
    run(PELLICLE, "phantom", "blobs", "--size", "24", "--seed", "7", "-o", image)
    for end in ("minimum", "maximum"):
        sliders = {text(p, "name"): text(p.find("constraints"), end) for p in parameters
                   if p.find("constraints") is not None}
        expect(len(sliders) > 5, "no sliders")
        done = run(*command_line(parameters, image, mesh,
                                 {**ISO, **sliders, "max_iterations": "2"}))
        expect(done.returncode == 0, f"sliders at their {end}: {done.stderr}")
        expect(run(PELLICLE, "check", mesh).returncode == 0, f"sliders at their {end}: not valid")


def check_cancel(parameters):
    """However it is stopped, nothing is left; on SIGTERM it says so."""
    image, folder = f"{FOLDER}/sponge.nrrd", f"{FOLDER}/out"
    run(PELLICLE, "phantom", "sierpinski", "-o", image)
    os.mkdir(folder)
    values = {"iso": "100", "levels": "0"}
    for how, code in ((signal.SIGTERM, 130), (signal.SIGKILL, -signal.SIGKILL)):
        process = subprocess.Popen(command_line(parameters, image, f"{folder}/sponge.vtp", values),
                                   stdout=subprocess.PIPE, text=True, stderr=subprocess.DEVNULL)
        for line in process.stdout:  # until it is on its way
            if PROGRESS.search(line) and float(PROGRESS.search(line)[1]) > 0:
                break
        process.send_signal(how)
        since = time.monotonic()
        process.stdout.read()
        expect(process.wait() == code, f"{how.name}: exit code {process.returncode}")
        expect(time.monotonic() - since < 20, f"{how.name}: takes long")
        expect(os.listdir(folder) == [], f"{how.name}: leaves {os.listdir(folder)}")


def check_labels(parameters):
    """The module of label images: one mesh of all, with names where the user has a table."""
    image, mesh, names = (f"{FOLDER}/{name}" for name in ("cells.nrrd", "cells.vtp", "cells.ctbl"))
    run(PELLICLE, "phantom", "labels", "--size", "30", "--count", "2", "-o", image)
    with open(names, "w") as table:
        table.write("1 cortex 10 20 30 255\n")
    done = run(*command_line(parameters, image, mesh, {"names": names}))
    expect(done.returncode == 0 and done.stderr == "", f"labels: {done.returncode}, {done.stderr}")
    expect(done.stdout.rstrip().endswith("</filter-end>"), "labels: no progress")
    expect(run(PELLICLE, "check", mesh).returncode == 0, "labels: the mesh is not valid")
    with open(mesh, "rb") as written:
        expect(b"LabelNames" in written.read(), "labels: the mesh has no names")


described = read_description("--xml")
check_parameters(described)
check_run(described)
check_values(described)
check_cancel(described)
labels = read_description("--xml-labels")
check_parameters(labels)
check_labels(labels)
if failures:
    sys.exit(f"{failures} failures")
print("All as expected.")
