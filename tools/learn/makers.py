"""Which files there are, who made them, and which makers a fold leaves out. Makers are left out whole.

Files to report on only (`creatures/check`, `wild/judge`) are never trained on, and neither is another copy of them.
"""
import csv
import glob
import os
import re
from dataclasses import dataclass

MADE_PEOPLE = "made_people/"  # by MakeHuman's data: learned from, but in no table and no count
MODELS = (".glb", ".gltf", ".fbx", ".vrm")
REPORT_ONLY = ("creatures/check/", "wild/judge/")
LEARN_FROM = ("wild/", "rigged/", "creatures/tune/", MADE_PEOPLE)
# Beginnings of file names in folders that mix makers, and other names of the same maker.
PREFIXES = {
    "m2m": "mesh2motion", "wilhelmine": "skandarella", "elceejo": "elceejo", "kaykit": "kaykit", "kenney": "kenney",
    "quaternius": "quaternius", "makehuman": "makehuman", "cesium": "khronos", "fox_khronos": "khronos",
    "rigged_simple": "khronos", "simple_skin": "khronos", "robot_expressive": "quaternius", "swift502": "swift502",
    "made_people": "makehuman",
}
LICENCES = {"quaternius": "CC0-1.0", "kaykit": "CC0-1.0", "kenney": "CC0-1.0", "mesh2motion": "CC0-1.0",
            "makehuman": "CC0-1.0", "elceejo": "MIT", "skandarella": "MIT", "swift502": "MIT",
            "code": "made by this project"}
CODE = "code"  # the maker of bodies made by code: in every fold's training


@dataclass
class Source:
    path: str
    file: str  # below the data's folder
    maker: str
    licence: str
    report_only: bool

    @property
    def name(self):
        """A file name for what is made of it."""
        return re.sub(r"[^A-Za-z0-9_-]+", "__", self.file.removesuffix(".glb"))

    @property
    def stem(self):
        return stem_of(self.file)


def stem_of(file):
    """What is left of the name without its maker: the same in two collections of one file."""
    stem = os.path.splitext(os.path.basename(file))[0].lower()
    for prefix in PREFIXES:
        stem = stem.removeprefix(prefix + "_")
    return re.sub(r"(_transformed|[^a-z0-9])", "", stem)


def maker_of(file):
    folders, base = file.split("/")[:-1], os.path.basename(file).lower()
    if folders[:1] == ["wild"]:
        return folders[2] if folders[1] == "judge" and len(folders) > 2 else folders[1]
    for prefix in sorted(PREFIXES, key=len, reverse=True):
        if base.startswith(prefix) or any(folder.startswith(prefix) for folder in folders):
            return PREFIXES[prefix]
    return folders[0] if folders else base


def sources(data, folders=LEARN_FROM + REPORT_ONLY):
    """All rigged files below the data's folder that are learned from or reported on."""
    licences = {}
    manifest = os.path.join(data, "wild", "MANIFEST.tsv")
    if os.path.exists(manifest):
        with open(manifest, encoding="utf-8") as file:
            licences = {"wild/" + row["file"]: row["licence"] for row in csv.DictReader(file, delimiter="\t")}
    found = []
    for path in sorted(glob.glob(os.path.join(glob.escape(data), "**", "*"), recursive=True)):
        file = os.path.relpath(path, data)
        if not file.lower().endswith(MODELS) or not file.startswith(tuple(folders)) or "rigonly" in file:
            continue
        maker = maker_of(file)
        found.append(Source(path, file, maker, licences.get(file, LICENCES.get(maker, "see the data's manifest")),
                            file.startswith(REPORT_ONLY)))
    reported = {(source.maker, source.stem) for source in found if source.report_only}
    for source in found:
        source.report_only |= (source.maker, source.stem) in reported
    return found


def folds(counts, count=4):
    """Makers in `count` groups of about the same number of bodies; `counts`: bodies by maker. Deterministic."""
    groups = [[] for _ in range(count)]
    sizes = [0] * count
    for maker in sorted(counts, key=lambda m: (-counts[m], m)):
        if maker == CODE:
            continue
        k = sizes.index(min(sizes))
        groups[k].append(maker)
        sizes[k] += counts[maker]
    return groups
