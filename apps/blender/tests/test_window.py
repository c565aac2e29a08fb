# The add-on in a window: it works while Blender goes on, is one step to undo, and Escape stops it.
#
#   xvfb-run -a blender --no-window-focus -noaudio --factory-startup --python test_window.py -- ADDON.zip PROGRAM WORK_FOLDER
#
# Ends with "N passed, N failed".
import os
import stat
import sys
import time
import traceback

import bpy

ADDON, PROGRAM, WORK = (os.path.abspath(path) for path in sys.argv[sys.argv.index("--") + 1:])
os.makedirs(WORK, exist_ok=True)
bpy.ops.preferences.addon_install(overwrite=True, filepath=ADDON)
bpy.ops.preferences.addon_enable(module="limber")

# The program, three seconds late: so that it is under way for a while.
SLOW = os.path.join(WORK, "slow")
with open(SLOW, "w") as file:
    file.write(f'#!/bin/sh\n[ "$1" = --version ] || sleep 3\nexec "{PROGRAM}" "$@"\n')
os.chmod(SLOW, os.stat(SLOW).st_mode | stat.S_IXUSR)
bpy.context.preferences.addons["limber"].preferences.program = SLOW


def in_view():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return bpy.context.temp_override(window=window, area=area, region=next(region for region in area.regions if region.type == "WINDOW"))


def armatures():
    return [one for one in bpy.data.objects if one.type == "ARMATURE"]


def story():
    """Yields for as long as Blender is to go on by itself; each yield is a tenth of a second."""
    yield
    with in_view():
        bpy.ops.object.select_all(action="DESELECT")
        bpy.data.objects["Cube"].select_set(True)
        bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
        bpy.ops.object.modifier_add(type="SUBSURF")
        bpy.context.scene.limber.kind = "handles"
        bpy.ops.ed.undo_push(message="before")
        assert bpy.ops.limber.rig("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    ticks = 0
    while not armatures():
        ticks += 1
        assert ticks < 200, "it does not end"
        yield
    assert ticks > 2, f"Blender stood still: {ticks} ticks in three seconds"  # frames are drawn in software
    assert bpy.data.objects["Cube"].find_armature() and [m.type for m in bpy.data.objects["Cube"].modifiers] == ["SUBSURF", "ARMATURE"]
    print("passed: it works while Blender goes on")
    with in_view():
        bpy.ops.ed.undo()
    yield
    assert not armatures() and not bpy.data.objects["Cube"].vertex_groups and [m.type for m in bpy.data.objects["Cube"].modifiers] == ["SUBSURF"]
    print("passed: one step is undone")
    with in_view():
        bpy.ops.limber.rig("INVOKE_DEFAULT")
    yield
    folders = [name for name in os.listdir(os.environ["TMPDIR"]) if name.startswith("limber-")]
    assert folders, "no call is under way"
    window = bpy.context.window_manager.windows[0]
    window.event_simulate(type="ESC", value="PRESS", x=300, y=300)
    began = time.monotonic()
    while [name for name in os.listdir(os.environ["TMPDIR"]) if name.startswith("limber-")]:
        assert time.monotonic() - began < 3, "Escape does not stop it"
        yield
    for _ in range(15):
        yield
    assert not armatures()
    print("passed: Escape stops it, and no file stays")


TOLD = story()


def tick():
    try:
        next(TOLD)
        return 0.1
    except StopIteration:
        print("3 passed, 0 failed")
    except Exception:
        traceback.print_exc(file=sys.stdout)
        print("0 passed, 1 failed")
    sys.stdout.flush()
    os._exit(0)


bpy.app.timers.register(tick, first_interval=1)
