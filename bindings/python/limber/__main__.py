"""python -m limber: the program, with its own options."""
import os
import pathlib
import sys

program = pathlib.Path(__file__).parent / "bin" / "limber"
if not program.exists():
    sys.exit("limber: the program is not beside this package; install the wheel, or call limber itself")
os.execv(program, ["limber", *sys.argv[1:]])
