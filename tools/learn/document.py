"""The figures of docs/reading.md, made anew between its marks from the runs that were trained and read.

What a run says of makers that it was trained on stands beside what runs say that never saw them, or not at all.
"""
import os
import re
from collections import Counter

import tables
from export import trained_for
import vocabulary as words
from evaluate import about_run, load_rows
from makers import CODE, LICENCES

MARK = "made by ./dev learn"
SECTIONS = ("training", "groups", "kinds", "confidence", "joints", "parts", "fingers", "makers", "reported", "seeds",
            "curve")


def rewrite(page, sections):
    """Puts each section's text between its marks; None leaves what is there. Returns the names of those left."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    for name, section in sections.items():
        if section is None:
            continue
        marks = re.compile(rf"(<!-- {MARK} \w+: {name} -->\n).*?(<!-- end of {name} -->)", re.S)
        if not marks.search(text):
            raise SystemExit(f"{page} has no marks for {name}")
        text = marks.sub(lambda found: f"{found[1]}\n{section.strip()}\n\n{found[2]}", text)
    with open(page, "w", encoding="utf-8") as file:
        file.write(text)
    return [name for name, section in sections.items() if section is None]


def has_rows(run):
    return os.path.exists(os.path.join(run, "rows.json"))


def is_outdated(run):
    """Whether the run was trained further after it was read."""
    read, trained = (os.path.getmtime(os.path.join(run, name)) for name in ("rows.json", "state.pt"))
    return read < trained


def training(run):
    """What a run was trained on: the card's table."""
    about, cost = about_run(run), trained_for(run, "reading")
    made = about["makers"].get(CODE, 0)
    lines = [[maker, count, about["licences"].get(maker) or LICENCES.get(maker, "")]
             for maker, count in sorted(about["makers"].items(), key=lambda item: (-item[1], item[0]))]
    plans = ", ".join(f"{plan} {about['plans'].get(plan, 0)}" for plan in words.PLANS)
    return (f"{about['bodies'] - made} rigged models of {len(lines) - bool(made)} makers and {made} bodies made by "
            f"code; {cost['samples']:,} samples, {cost['hours']:.1f} hours, seed "
            f"{about['options']['seed']}, {about['numbers']:,} numbers. By kind: {plans}.\n\n"
            + tables.markdown(["maker", "files", "licence"], lines))


def left_out(folds, calibration):
    """name -> text of the tables of makers left out."""
    rows = load_rows(folds)
    bodies = tables.once([row for row in rows if not row["report_only"]])
    if not bodies:
        return {}
    temperature, factor = calibration.get("plan_temperature", 1.0), calibration.get("error_factor", 1.0)
    samples = " to ".join(f"{n:,}" for n in sorted({min(r["samples"] for r in rows), max(r["samples"] for r in rows)}))
    sure = tables.percent_of(tables.sure_and_wrong(bodies, temperature))
    makers = len({row["maker"] for row in bodies})
    return {
        "groups": f"{len(folds)} networks of {samples} samples each; {len(bodies)} bodies of {makers} makers, each "
                  "read by the network that did not see its maker.\n\n"
                  + tables.table("group", tables.by_group(bodies)),
        "kinds": tables.table("kind", tables.by_plan(bodies)) + "\n\n" + tables.confusion(bodies),
        "confidence": f"{tables.kind_confidence(bodies, temperature)}\n\nWrong among those with a confidence of "
                      f"{tables.SURE} and more: {sure}.\n\n{tables.error_confidence(bodies, factor)}",
        "joints": tables.joint_errors(bodies), "parts": tables.part_table(bodies),
        "fingers": tables.other_figures(bodies), "makers": tables.table("maker", tables.by_maker(bodies)),
    }


def reported(folds, whole):
    """Files to report only: by the folds that left their makers out, and by the network of all makers."""
    if not folds or not has_rows(whole):
        return None
    pick = lambda rows, seen: tables.once([r for r in rows if r["report_only"] and r["maker_seen"] == seen])
    unseen, seen = (pick(load_rows([whole]), known) for known in (False, True))
    bodies = {(row["maker"], row["stem"]) for row in seen}
    again = [row for row in pick(load_rows(folds), False) if (row["maker"], row["stem"]) in bodies]
    return tables.side_by_side({"all makers' network, which saw none of the maker": unseen,
                                "the fold that left the maker out": again,
                                "all makers' network, which saw other files of the maker": seen if again else []})


def rows_left_out(run):
    """Rows of the makers that a run was told to leave out, not of those that it happened to draw nothing of."""
    makers = about_run(run)["options"]["leave_out"]
    return [row for row in load_rows([run]) if row["maker"] in makers and not row["report_only"]]


def seeds(runs):
    """Runs that differ in nothing but their seeds; the bodies are those that all of them were judged by."""
    alike = {}
    for run in runs:
        options = about_run(run)["options"]
        key = (tuple(sorted(options["leave_out"])), options["bodies"], options["samples"], options["start"])
        alike.setdefault(key, {})[options["seed"]] = run
    parts = []
    for (without, _, samples, _), by_seed in sorted(alike.items(), key=str):
        if len(by_seed) > 1:
            if without:
                rows = {seed: rows_left_out(run) for seed, run in sorted(by_seed.items())}
                title = f"Without {', '.join(without)}, and on these"
            else:
                rows = {seed: load_rows([run]) for seed, run in sorted(by_seed.items())}
                title = "All makers, on files to report only (of most makers it saw other files)"
            parts.append(f"{title}; {samples:,} samples:\n\n" + tables.seeds_table(rows))
    return "\n\n".join(parts) or None


def curve(runs):
    """Runs on few and many bodies, on the makers that they left out."""
    found = []
    for run in runs:
        makers = Counter(about_run(run)["makers"])
        samples = about_run(run)["options"]["samples"]
        found.append((makers.total() - makers[CODE], samples, rows_left_out(run)))
    if len(found) < 2:
        return None
    found.sort(key=lambda entry: entry[:2])
    samples = " to ".join(f"{n:,}" for n in sorted({found[0][1], found[-1][1]}))
    return f"{samples} samples each, bodies made by code beside them:\n\n" + tables.curve_table(
        [(bodies, rows) for bodies, _, rows in found])
