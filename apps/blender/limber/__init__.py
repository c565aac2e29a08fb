"""limber in Blender: rigs, weights and motions for the objects of the scene, by the program limber, or by its npm package in Node."""
import os

import bpy
from mathutils import Vector

from . import program, scene
from .program import LimberError

bl_info = {
    "name": "limber", "author": "limber maintainers", "version": (0, 1, 0), "blender": (3, 4, 0), "category": "Rigging",
    "location": "3D View > Sidebar > limber", "description": "Rig, weight and retarget with limber",
}

TEMPLATES = ("auto", "humanoid", "humanoid-fingers", "quadruped", "bird", "dinosaur", "crawler", "dragon", "spider", "insect", "fish", "serpent")
SKINNING = ("bone-heat", "geodesic-voxel", "bounded-biharmonic", "envelopes", "nearest-bone")
CORRECTIONS = "limber joints"  # the collection of the empties


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: bpy.props.StringProperty(name="Program", subtype="FILE_PATH", description="limber itself; empty: looked for on the path")
    node: bpy.props.StringProperty(name="Node", subtype="FILE_PATH", description="Where there is no program: Node 20 or newer; empty: looked for on the path")
    package: bpy.props.StringProperty(name="npm package", subtype="DIR_PATH", description="For Node: the folder where limber's package was "
                                      "installed; empty: beside the add-on, or where npm i -g puts it")

    def draw(self, context):
        for name in ("program", "node", "package"):
            self.layout.prop(self, name)
        self.layout.operator(Find.bl_idname)


def found_program(context):
    """By the preferences. Throws LimberError."""
    addon = context.preferences.addons.get(__package__)
    named = [bpy.path.abspath(getattr(addon.preferences, name)) for name in ("program", "node", "package")] if addon else []
    return program.find(*named)


class Find(bpy.types.Operator):
    """Says what will do the work, or what is missing"""
    bl_idname = "limber.find"
    bl_label = "Look for limber"

    def execute(self, context):
        try:
            self.report({"INFO"}, str(found_program(context)))
        except LimberError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class Settings(bpy.types.PropertyGroup):
    """Of the scene."""
    kind: bpy.props.EnumProperty(name="Joints", items=[
        ("template", "Named skeleton", "A skeleton with names, fitted into the model"),
        ("handles", "Handles", "As many joints as wanted, wherever the model is thick"),
        ("curve-skeleton", "Along limbs", "Joints on curves through the middle of limbs")], default="template")
    template: bpy.props.EnumProperty(name="Body", items=[(name, name, "") for name in TEMPLATES])
    handles: bpy.props.IntProperty(name="How many", min=0, max=200, default=0, description="0: as many as suit the model")
    skinning: bpy.props.EnumProperty(name="Weights", items=[(name, name, "") for name in SKINNING])
    motion: bpy.props.StringProperty(name="Motion", subtype="FILE_PATH", description=".bvh, .glb, .gltf, .fbx or .dae")
    source: bpy.props.PointerProperty(name="Or from", type=bpy.types.Object, poll=lambda _, obj: obj.type == "ARMATURE",
                                      description="Another armature, whose action is put on this one")


def selected_meshes(context):
    objects = [obj for obj in context.selected_objects if obj.type == "MESH"]
    if not objects:
        raise LimberError("select the mesh objects of the model first")
    for obj in objects:
        if obj.mode != "OBJECT":
            raise LimberError(f"{obj.name} is being edited: go to Object mode first")
        if obj.data.users > 1 or obj.data.library or obj.library:
            raise LimberError(f"{obj.name} shares its mesh, or is linked: make it a single user first")
    return sorted(objects, key=lambda obj: obj.name)


def chosen_armature(context):
    obj = context.active_object
    if obj and obj.type == "ARMATURE":
        return obj
    for one in context.selected_objects:
        if one.type == "ARMATURE":
            return one
    armature = obj and obj.type == "MESH" and obj.find_armature()
    if not armature:
        raise LimberError("select an armature, too")
    return armature


def meshes_of(armature):
    objects = (obj for obj in bpy.context.scene.objects if obj.type == "MESH" and obj.find_armature() == armature and obj.data.polygons)
    return sorted(objects, key=lambda obj: obj.name)


def corrections():
    """By joint: the empty that was made for it."""
    folder = bpy.data.collections.get(CORRECTIONS)
    return {empty["limber_joint"]: empty for empty in folder.objects if "limber_joint" in empty} if folder else {}


def pins(objects, template):
    """Of joints whose empty was moved, as the program takes them; of corrections of this very model alone."""
    folder, arguments = bpy.data.collections.get(CORRECTIONS), []
    if folder and (list(folder["limber_objects"]) != [obj.name for obj in objects] or folder["limber_template"] != template):
        raise LimberError(f"the joints to correct are those of {', '.join(folder['limber_objects'])} as {folder['limber_template']}: "
                      f"select that, or delete the collection {CORRECTIONS}")
    for joint, empty in sorted(corrections().items()):
        position = empty.matrix_world.translation
        if joint in folder["limber_pinned"] or (position - Vector(empty["limber_position"])).length > 1e-5:
            x, y, z = (scene.TURN @ position)[:3]
            arguments += ["--pin", f"{joint}={x!r},{y!r},{z!r}"]
    return arguments


def forget_corrections():
    for empty in corrections().values():
        bpy.data.objects.remove(empty)
    folder = bpy.data.collections.get(CORRECTIONS)
    if folder and not folder.objects:
        bpy.data.collections.remove(folder)


class Call(bpy.types.Operator):
    """Writes what the program needs, lets it work, and takes what it gives; nothing of the scene changes before that."""
    bl_options = {"REGISTER", "UNDO"}
    under_way = False  # of all operators one at a time

    def prepare(self, context, folder):
        """The program's arguments, once its files are in the folder."""
        raise NotImplementedError

    def apply(self, context, folder):
        """What is message of it."""
        raise NotImplementedError

    def start(self, context):
        self.program = found_program(context)
        folder = program.new_folder()
        try:
            self.call = program.Call(self.program, self.prepare(context, folder.name), folder)
        except BaseException:
            folder.cleanup()
            raise

    def finish(self, context):
        try:
            self.call.check()
            message = self.apply(context, self.call.folder.name)
        except LimberError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            self.end()
        self.report({"INFO"}, message)
        return {"FINISHED"}

    def end(self):
        self.call.stop()
        self.call.folder.cleanup()

    def execute(self, context):
        try:
            self.start(context)
        except LimberError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.call.wait()
        return self.finish(context)

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        if Call.under_way:
            self.report({"ERROR"}, "limber is at work: wait for it, or stop it by Escape")
            return {"CANCELLED"}
        try:
            self.start(context)
        except LimberError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        Call.under_way = True
        self.timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        context.workspace.status_text_set(f"limber: {self.bl_label} (Esc stops it)")
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.leave(context)
            self.end()
            return {"CANCELLED"}
        if event.type != "TIMER" or not self.call.poll():
            return {"PASS_THROUGH"}
        self.leave(context)
        return self.finish(context)

    def cancel(self, context):
        """Blender opens another file, or ends."""
        self.leave(context)
        self.end()

    def leave(self, context):
        Call.under_way = False
        context.window_manager.event_timer_remove(self.timer)
        context.workspace.status_text_set(None)


class Rig(Call):
    """Joints and weights for the selected objects"""
    bl_idname = "limber.rig"
    bl_label = "Rig"

    def prepare(self, context, folder):
        objects, settings = selected_meshes(context), context.scene.limber
        for obj in objects:
            if obj.find_armature():
                raise LimberError(f"{obj.name} follows the armature {obj.find_armature().name}: take weights for that, or remove its modifier")
        self.objects = [obj.name for obj in objects]
        scene.write_meshes(objects, os.path.join(folder, "in.glb"))
        joints = {"template": ["--template", settings.template], "handles": ["--handles", str(settings.handles)] if settings.handles else [],
                  "curve-skeleton": ["--rigger", "curve-skeleton"] + (["--handles", str(settings.handles)] if settings.handles else [])}[settings.kind]
        if settings.kind == "template":
            joints = joints + pins(objects, settings.template)
        return ["rig", "in.glb", *joints, "--skinning", settings.skinning, "-o", "out.glb"]

    def apply(self, context, folder):
        objects = scene.objects_of(self.objects, folder)
        if any(obj.find_armature() for obj in objects):
            raise LimberError("the model got an armature while limber was at work")
        armature = scene.apply_rig(objects, os.path.join(folder, "out.glb"))
        forget_corrections()
        return f"{len(armature.data.bones)} joints"


class Joints(Call):
    """Shows where the joints of the named skeleton would be, as empties to be moved; Rig then keeps those that were"""
    bl_idname = "limber.joints"
    bl_label = "Fit template"

    def prepare(self, context, folder):
        objects, self.template = selected_meshes(context), context.scene.limber.template
        self.objects, arguments = [obj.name for obj in objects], pins(objects, self.template)
        self.pinned = [argument.split("=")[0] for argument in arguments[1::2]]
        scene.write_meshes(objects, os.path.join(folder, "in.glb"))
        return ["rig", "in.glb", "--template", self.template, *arguments, "-o", "out.glb"]

    def apply(self, context, folder):
        positions = scene.joint_positions(os.path.join(folder, "out.glb"))
        forget_corrections()
        collection = bpy.data.collections.new(CORRECTIONS)
        collection["limber_objects"], collection["limber_template"] = self.objects, self.template
        collection["limber_pinned"] = self.pinned or [""]  # corrected before: they stay so
        context.scene.collection.children.link(collection)
        size = max((a - b).length for a in positions.values() for b in positions.values())
        for joint, position in positions.items():
            empty = bpy.data.objects.new(joint, None)
            empty.empty_display_type, empty.empty_display_size, empty.show_in_front = "SPHERE", 0.015 * size, True
            empty.location = position
            empty["limber_joint"], empty["limber_position"] = joint, tuple(position)
            collection.objects.link(empty)
        return f"{len(positions)} joints to correct"


class Weights(Call):
    """Weights of the selected objects for the selected armature"""
    bl_idname = "limber.weights"
    bl_label = "Weights for this armature"

    def prepare(self, context, folder):
        armature, objects = chosen_armature(context), selected_meshes(context)
        for obj in objects:
            if obj.find_armature() not in (None, armature):
                raise LimberError(f"{obj.name} follows the armature {obj.find_armature().name}: remove its modifier first")
        self.armature, self.objects = armature.name, [obj.name for obj in objects]
        scene.write_character(armature, objects, os.path.join(folder, "in.glb"), are_bound=False)
        return ["rig", "in.glb", "--keep-skeleton", "--skinning", context.scene.limber.skinning, "-o", "out.glb"]

    def apply(self, context, folder):
        reader = scene.glb.Reader(os.path.join(folder, "out.glb"))
        objects, armature = scene.objects_of(self.objects, folder), bpy.data.objects.get(self.armature)
        if armature is None:
            raise LimberError(f"{self.armature} is gone")
        scene.apply_weights(objects, reader.skin()[0], reader)
        for obj in objects:
            scene.bind(obj, armature)
        return f"weights of {len(objects)} objects"


def check_package_retargets(armature, objects, motion):
    """Throws LimberError for what the npm package does not do."""
    if not motion.lower().endswith((".bvh", ".glb", ".gltf")):
        raise LimberError(f"{os.path.basename(motion)} needs the program limber: in Node it reads .bvh, .glb and .gltf")
    if not objects:
        raise LimberError(f"no mesh follows {armature.name}: to move an armature alone needs the program limber, not Node")


class Retarget(Call):
    """Puts a motion out of a file, or another armature's action, onto the selected armature"""
    bl_idname = "limber.retarget"
    bl_label = "Retarget"

    def prepare(self, context, folder):
        armature, settings = chosen_armature(context), context.scene.limber
        self.armature = armature.name
        if settings.source:
            if settings.source == armature:
                raise LimberError("the motion is that of the armature itself: choose another")
            motion = "motion.glb"
            scene.write_motion(settings.source, os.path.join(folder, motion))
        else:
            motion = os.path.abspath(bpy.path.abspath(settings.motion))
            if not os.path.isfile(motion):
                raise LimberError("choose a file with a motion, or an armature that has one")
        objects = meshes_of(armature)
        if self.program.is_package:
            check_package_retargets(armature, objects, motion)
        scene.write_character(armature, objects, os.path.join(folder, "in.glb"))
        return ["retarget", "in.glb", motion, "-o", "out.glb"]

    def apply(self, context, folder):
        armature = bpy.data.objects.get(self.armature)
        if armature is None:
            raise LimberError(f"{self.armature} is gone")
        actions = scene.apply_clips(armature, os.path.join(folder, "out.glb"))
        context.scene.frame_end = max(context.scene.frame_end, int(actions[-1].frame_range[1]))
        return f"{', '.join(action.name for action in actions)} put on"


class Panel(bpy.types.Panel):
    bl_idname = "LIMBER_PT_panel"
    bl_label = "limber"
    bl_category = "limber"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    def draw(self, context):
        layout, settings = self.layout, context.scene.limber
        layout.prop(settings, "kind")
        layout.prop(settings, "template" if settings.kind == "template" else "handles")
        layout.prop(settings, "skinning")
        if settings.kind == "template":
            layout.operator(Joints.bl_idname)
        layout.operator(Rig.bl_idname)
        layout.operator(Weights.bl_idname)
        layout.separator()
        layout.prop(settings, "motion")
        layout.prop(settings, "source")
        layout.operator(Retarget.bl_idname)


CLASSES = (Find, Preferences, Settings, Rig, Joints, Weights, Retarget, Panel)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.limber = bpy.props.PointerProperty(type=Settings)


def unregister():
    del bpy.types.Scene.limber
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
