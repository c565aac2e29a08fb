"""The program limber: where it is, and one call of it."""
import os
import shutil
import subprocess
import tempfile

NEEDED = (0, 1)


class LimberError(Exception):
    """What went wrong and what to do, in one line."""


def find(preferred=""):
    """The program: as the preferences have it, else on the path. Throws LimberError."""
    program = os.path.abspath(preferred) if preferred else shutil.which("limber")
    if not program or not os.access(program, os.X_OK):
        where = f"is not at {preferred}" if preferred else "is not on the path"
        raise LimberError(f"the program limber {where}: install it, or name it in the add-on's preferences")
    try:
        version = subprocess.run([program, "--version"], capture_output=True, text=True, timeout=20).stdout.split()
    except (OSError, subprocess.TimeoutExpired) as problem:
        raise LimberError(f"{program} does not start: {problem}") from problem
    if len(version) != 2 or version[0] != "limber":
        raise LimberError(f"{program} is not limber: name another in the add-on's preferences")
    numbers = [int(part) if part.isdigit() else 0 for part in version[1].split(".")[:2]]
    if tuple(numbers) < NEEDED:
        raise LimberError(f"{program} is limber {version[1]}; {'.'.join(map(str, NEEDED))} is needed: install a newer one")
    return program


class Call:
    """A call in a temporary folder of its own, under way until `poll` gives True."""

    def __init__(self, program, arguments, folder):
        self.folder = folder
        self.errors = open(os.path.join(folder.name, "errors"), "w+", encoding="utf-8", errors="replace")
        self.process = subprocess.Popen([program, *arguments, "--quiet"], cwd=folder.name, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=self.errors)

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
