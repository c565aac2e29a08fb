"""What does limber's work: the program, or Node with limber's npm package; where it is, and one call of it."""
import dataclasses
import json
import os
import shutil
import subprocess
import tempfile

NEEDED = (0, 1)
NEEDED_NODE = 20
HIDDEN = getattr(subprocess, "CREATE_NO_WINDOW", 0)  # Windows opens a console window otherwise
GET_PACKAGE = "npm i -g limber-*.tgz"


class LimberError(Exception):
    """What went wrong and what to do, in one line."""


@dataclasses.dataclass
class Program:
    command: list  # a call begins with it
    version: str
    is_package: bool = False  # it has rig and retarget alone, and reads .bvh and glTF alone

    def __str__(self):
        return f"limber {self.version}: {' '.join(self.command)}"


def output_of(command, path=None):
    """What it prints, stripped. Throws LimberError where it does not start."""
    try:
        environment = {**os.environ, "PATH": path} if path else None
        return subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=20, env=environment, creationflags=HIDDEN).stdout.strip()
    except (OSError, subprocess.TimeoutExpired) as problem:
        raise LimberError(f"{command[0]} does not start: {problem}") from problem


def check_version(where, version):
    numbers = [int(part) if part.isdigit() else 0 for part in version.split(".")[:2]]
    if tuple(numbers) < NEEDED:
        raise LimberError(f"{where} is limber {version}; {'.'.join(map(str, NEEDED))} is needed: install a newer one")


def native(program):
    """The program in this file. Throws LimberError."""
    words = output_of([program, "--version"]).split()
    if len(words) != 2 or words[0] != "limber":
        raise LimberError(f"{program} is not limber: name another in the add-on's preferences")
    check_version(program, words[1])
    return Program([program], words[1])


def on_path():
    """The program; not the command of an npm package that is installed for all: that goes with the Node that is asked for below."""
    found = shutil.which("limber")
    return None if found and os.path.realpath(found).lower().endswith((".mjs", ".js", ".cmd", ".ps1")) else found


def node_path(preferred):
    """Node, new enough. Throws LimberError."""
    node = os.path.abspath(preferred) if preferred else shutil.which("node")
    if not node or not os.access(node, os.X_OK):
        where = f"no Node at {preferred}" if preferred else "neither the program limber nor Node is on the path"
        raise LimberError(f"{where}: install limber, or Node {NEEDED_NODE} or newer and its package ({GET_PACKAGE}), or name them in the add-on's preferences")
    version = output_of([node, "--version"])
    major = version.removeprefix("v").split(".")[0]
    if not version.startswith("v") or not major.isdigit():
        raise LimberError(f"{node} is not Node: name another in the add-on's preferences")
    if int(major) < NEEDED_NODE:
        raise LimberError(f"{node} is Node {version}, too old: install Node {NEEDED_NODE} or newer, or the program limber")
    return node


def package_in(folder):
    """limber's package in a folder: the package itself, or where it was installed. None where it is not there."""
    for place in (folder, os.path.join(folder, "node_modules", "limber"), os.path.join(folder, "limber")):
        try:
            with open(os.path.join(place, "package.json"), encoding="utf-8") as file:
                if json.load(file).get("name") == "limber" and os.path.isfile(os.path.join(place, "bin", "limber.mjs")):
                    return place
        except (OSError, ValueError, AttributeError):
            continue
    return None


def package_path(node, preferred):
    """Where the package is: as the preferences have it, else beside the add-on, else installed for all. Throws LimberError."""
    if preferred:
        found = package_in(os.path.abspath(preferred))
        if not found:
            raise LimberError(f"{preferred} does not have limber's npm package: name the folder where it was installed")
        return found
    beside = package_in(os.path.dirname(os.path.abspath(__file__)))
    if beside:
        return beside
    path = os.path.dirname(node) + os.pathsep + os.environ.get("PATH", "")
    npm = shutil.which("npm", path=path)
    found = npm and package_in(output_of([npm, "root", "-g"], path))
    if not found:
        raise LimberError(f"Node is there, but neither the program limber nor its npm package: {GET_PACKAGE}, or name its folder in the add-on's preferences")
    return found


def with_node(node="", package=""):
    """The npm package's program in Node. Throws LimberError."""
    node = node_path(node)
    folder = package_path(node, package)
    with open(os.path.join(folder, "package.json"), encoding="utf-8") as file:
        version = str(json.load(file).get("version", "0"))
    check_version(folder, version)
    return Program([node, os.path.join(folder, "bin", "limber.mjs")], version, is_package=True)


def find(preferred="", node="", package=""):
    """The program that is named, else the one on the path, else Node with the npm package. Throws LimberError."""
    if preferred:
        program = os.path.abspath(preferred)
        if not os.access(program, os.X_OK) or os.path.isdir(program):
            raise LimberError(f"the program limber is not at {preferred}: install it, or name it in the add-on's preferences")
        return native(program)
    program = on_path()
    return native(program) if program else with_node(node, package)


class Call:
    """A call in a temporary folder of its own, under way until `poll` gives True."""

    def __init__(self, program, arguments, folder):
        self.folder = folder
        self.errors = open(os.path.join(folder.name, "errors"), "w+", encoding="utf-8", errors="replace")
        self.process = subprocess.Popen([*program.command, *arguments, "--quiet"], cwd=folder.name, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=self.errors, creationflags=HIDDEN)

    def poll(self):
        return self.process.poll() is not None

    def wait(self):
        self.process.wait()

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.errors.close()

    def check(self):
        """Throws LimberError with the program's own words where it did not end well."""
        self.errors.seek(0)
        words = [line for line in self.errors.read().splitlines() if line.strip()]
        if self.process.returncode != 0:
            raise LimberError(words[-1].removeprefix("limber: ") if words else f"limber ended with code {self.process.returncode}")


def new_folder():
    return tempfile.TemporaryDirectory(prefix="limber-")
