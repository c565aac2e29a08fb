"""Tables of rows (evaluate.py) as Markdown."""
import numpy as np

import vocabulary as words
from evaluate import NAMED, confidence, kind_right

GROUPS = {"people": "people", "toys": "toys and costumes", "four": "four-legged",
          "others": "birds, fish, insects, dinosaurs, snakes, dragons", "robots": "robots", "none": "things"}
CONFIDENCES = (0, 0.5, 0.7, 0.8, 0.9, 1.01)
SURE = 0.8  # the confidence from which on a wrong kind counts as sure and wrong


def once(rows):
    """One row for each body: copies of a file in two collections are one body, and of several runs the first counts."""
    first = {}
    for row in rows:
        first.setdefault((row["maker"], row["stem"]), row)
    return list(first.values())


def markdown(columns, lines):
    """Columns of figures are aligned to the right."""
    is_figure = lambda cell: str(cell)[:1] in "-0123456789"
    figures = [all(map(is_figure, column)) for column in zip(*lines)] or [False] * len(columns)
    aligned = ["---:" if right and k else "---" for k, right in enumerate(figures)]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in [columns, aligned, *lines])


def _known(values):
    return [value for value in values if value is not None]


def mean(values, digits=1):
    values = _known(values)
    return f"{np.mean(values):.{digits}f}" if values else "-"


def median(values):
    values = _known(values)
    return f"{np.median(values):.1f}" if values else "-"


def percent_of(hits):
    return f"{sum(hits)} of {len(hits)} ({100 * np.mean(hits):.0f} %)" if hits else "-"


def grouped(rows, key, names=None):
    """(title, rows) of each value of `key`, in the order of `names` where given, and of all."""
    values = sorted({key(row) for row in rows}, key=lambda value: list(names).index(value) if names else value)
    found = [((names or {}).get(value, value), [row for row in rows if key(row) == value]) for value in values]
    return found + [("all", rows)] * (len(found) > 1)


def by_group(rows):
    return grouped(rows, lambda row: row["group"], GROUPS)


def by_plan(rows):
    return grouped(rows, lambda row: words.PLANS[row["plan"]], {plan: plan for plan in words.PLANS})


def by_maker(rows):
    return grouped(rows, lambda row: row["maker"])


def _stance(rows, name):
    return [100 * row["stance"][name] for row in rows if "stance" in row]


COLUMNS = {  # of the main tables
    "files": len,
    "kind right, %": lambda rows: mean([100.0 * kind_right(row) for row in rows]),
    "J2J": lambda rows: mean([row["j2j"] for row in rows]),
    "its median": lambda rows: median([row["j2j"] for row in rows]),
    "named": lambda rows: mean([row["named"] for row in rows]),
    "joints missed or made up, %": lambda rows: mean([100 * row["has_wrong"] for row in rows]),
    "parts right, %": lambda rows: mean([100 * row["part"] for row in rows]),
    "bones": lambda rows: mean([row["bone"] for row in rows]),
    "front and up right, %": lambda rows: mean(_stance(rows, "right")),
    "up right, %": lambda rows: mean(_stance(rows, "up")),
}


def table(title, groups):
    lines = [[name, *(column(some) for column in COLUMNS.values())] for name, some in groups]
    return markdown([title, *COLUMNS], lines)


def confusion(rows):
    """What was said, by plan."""
    count = np.zeros((len(words.PLANS),) * 2, int)
    for row in rows:
        count[row["plan"], int(np.argmax(row["plan_logits"]))] += 1
    lines = [[plan, *(n or "" for n in line)] for plan, line in zip(words.PLANS, count) if line.any()]
    return markdown(["kind \\ said", *words.PLANS], lines)


def sure_and_wrong(rows, temperature=1.0, threshold=SURE):
    """Whether the kind is wrong, of each body whose kind has at least this confidence."""
    return [not kind_right(row) for row in rows if confidence(row, temperature).max() >= threshold]


def kind_confidence(rows, temperature=1.0):
    lines = []
    for low, high in zip(CONFIDENCES, CONFIDENCES[1:]):
        some = [row for row in rows if low <= confidence(row, temperature).max() < high]
        lines.append([f"{low} to {min(high, 1)}", mean([100 * confidence(row, temperature).max() for row in some]),
                      percent_of([kind_right(row) for row in some])])
    return markdown(["confidence", "its mean, %", "kind right"], lines)


def error_confidence(rows, error_factor=1.0):
    expected = error_factor * np.concatenate([row["expected"] for row in rows] or [[]])
    error = np.concatenate([row["error"] for row in rows] or [[]])
    fifths = [fifth for fifth in np.array_split(np.argsort(expected, kind="stable"), 5) if len(fifth)]
    return markdown(["joints, by expected error", "expected, %", "true, %"],
                    [[f"fifth {k + 1}", mean(expected[fifth]), mean(error[fifth])] for k, fifth in enumerate(fifths)])


def joint_errors(rows):
    """Median error of each named joint, both sides together, by group."""
    groups = [(name, some) for name, some in by_group(rows) if name not in ("all", GROUPS["none"])]
    lines = []
    for role in dict.fromkeys(name.removesuffix(".L").removesuffix(".R") for name in NAMED):
        sides = (role, role + ".L", role + ".R")
        cells = [median([row["roles"].get(name) for row in some for name in sides]) for _, some in groups]
        if any(cell != "-" for cell in cells):
            lines.append([f"`{role}`", *cells])
    return markdown(["joint", *(name for name, _ in groups)], lines)


def part_table(rows):
    """Of each part of the body: how much of it is found, and how much of what is called so is."""
    sums = {}
    for row in rows:
        for part, counts in row["parts"].items():
            sums[part] = np.array(counts) + sums.get(part, 0)
    percent = lambda some, of: f"{100 * some / of:.0f}" if of else "-"
    lines = []
    for part in dict.fromkeys(name.removesuffix(".L").removesuffix(".R") for name in words.PARTS):
        if part in sums:
            true, said, both = sums[part]
            lines.append([f"`{part}`", true, percent(both, true), percent(both, said)])
    return markdown(["part", "points", "found, %", "right where said, %"], lines)


def hands(rows, with_fingers):
    """Whether the number of fingers is right, of each hand that has fingers, or has none."""
    return [true == said for row in rows for true, said in zip(row["fingers"], row["fingers_said"])
            if (true > 0 if with_fingers else true == 0)]


def other_figures(rows):
    """Fingers and pins."""
    return markdown(["measure", "result"], [
        ["number of fingers right, hands that have some", percent_of(hands(rows, True))],
        ["no fingers where there are none", percent_of(hands(rows, False))],
        ["joints of fingers, mean error, % of the height", mean([row["finger_error"] for row in rows])],
        ["a limb was wrong, and is right as a whole after one pin", percent_of(_known(row["pin"] for row in rows))]])


def side_by_side(readings):
    """Kind and joints of each group below each other; readings: title -> rows."""
    shown = ("files", "kind right, %", "J2J", "named", "front and up right, %")
    lines = []
    for group in (*GROUPS, "all"):
        for title, rows in readings.items():
            some = [row for row in rows if group in (row["group"], "all")]
            if some:
                lines.append([GROUPS.get(group, group), title, *(COLUMNS[name](some) for name in shown)])
    return markdown(["group", "read by", *shown], lines)


def measures(rows):
    """The figures that runs are compared by: name -> number, or None."""
    number = lambda values: float(np.mean(values)) if (values := _known(values)) else None
    percent = lambda hits: number([100.0 * hit for hit in _known(hits)])
    group = lambda name: [row for row in rows if row["group"] == name]
    result = {"kind right, %": percent(map(kind_right, rows))}
    for name, title in GROUPS.items():
        result[f"kind right, %: {title}"] = percent(map(kind_right, group(name)))
    for name, title in GROUPS.items():
        result[f"J2J: {title}"] = number([row["j2j"] for row in group(name)])
    result["named"] = number([row["named"] for row in rows])
    result["parts right, %"] = percent([row["part"] for row in rows])
    result["front and up right, %"] = number(_stance(rows, "right"))
    result["number of fingers right, %"] = percent(hands(rows, True))
    result["limb right after one pin, %"] = percent([row["pin"] for row in rows])
    return result


def seeds_table(by_seed):
    """seed -> rows; only bodies that every run was judged by are compared."""
    key = lambda row: (row["maker"], row["stem"])
    common = set.intersection(*({key(row) for row in rows} for rows in by_seed.values()))
    columns = {seed: measures([row for row in once(rows) if key(row) in common]) for seed, rows in by_seed.items()}
    lines = []
    for name in next(iter(columns.values())):
        values = [column[name] for column in columns.values()]
        if None not in values:
            lines.append([name, *(f"{v:.1f}" for v in values), f"{np.mean(values):.1f}", f"{np.ptp(values):.1f}"])
    return markdown([f"{len(common)} files", *(f"seed {seed}" for seed in columns), "mean", "highest - lowest"], lines)


def curve_table(by_bodies):
    """(bodies, rows) of runs that learned from so many bodies."""
    names = ["kind right, %"] + [f"{kind}: {GROUPS[group]}" for kind in ("kind right, %", "J2J")
                                 for group in ("people", "toys", "four", "others")]
    lines = []
    for bodies, rows in by_bodies:
        found = measures(once(rows))
        lines.append([bodies, *("-" if found[name] is None else f"{found[name]:.1f}" for name in names)])
    return markdown(["bodies", *names], lines)


def report(rows, calibration=None):
    """All tables: makers left out, then files to report only, by whether their makers were left out."""
    calibration = calibration or {}
    temperature, factor = calibration.get("plan_temperature", 1.0), calibration.get("error_factor", 1.0)
    reported = [row for row in rows if row["report_only"]]
    sections = {"Makers left out": [row for row in rows if not row["report_only"]],
                "Files to report only, makers left out": [row for row in reported if not row["maker_seen"]],
                "Files to report only, makers seen in training": [row for row in reported if row["maker_seen"]]}
    parts = []
    for title, some in sections.items():
        some = once(some)
        if some:
            parts += [f"## {title}", table("group", by_group(some)), table("kind", by_plan(some)),
                      table("maker", by_maker(some)), confusion(some), kind_confidence(some, temperature),
                      "Sure (0.8 and more) and wrong: " + percent_of(sure_and_wrong(some, temperature)),
                      error_confidence(some, factor), joint_errors(some), part_table(some), other_figures(some)]
    return "\n\n".join(parts) + "\n"
