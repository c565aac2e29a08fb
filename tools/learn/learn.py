#!/usr/bin/python3
"""Learns limber's reading of shapes from rigged models. See README.md beside this file.

    learn.py prepare              rigged files -> samples and labels
    learn.py make N               bodies made by code, and people by MakeHuman's data
    learn.py train KIND           KIND: reading or stance; --fold K leaves out a fold's makers; goes on where it stopped
    learn.py evaluate             reads what each trained run may be judged by; tables of the folds' left out makers
    learn.py calibrate            temperature, error factor and threshold from the folds
    learn.py export FILE          the weights file
    learn.py curve                figures over the number of bodies
    learn.py document             the figures of docs/reading.md
    learn.py pictures             bodies that were not trained on, with what is said of them: docs/images/reading_N.png
    learn.py folds                which makers each fold leaves out

Every step can be run again; all seeds are fixed. What is made lies in --work, outside of the repository.
"""
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # samplers run beside each other; --threads sets torch's own

import argparse
import glob
import json
import subprocess
import sys
from collections import Counter

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
REPOSITORY = os.path.dirname(os.path.dirname(HERE))
BESIDE = os.path.dirname(REPOSITORY)
FOLDS = 4
PAGE = os.path.join(REPOSITORY, "docs", "reading.md")


def prepared(options):
    return os.path.join(options.work, "prepared")


def run_folder(options, kind, fold=None, seed=1):
    name = kind if fold is None else f"{kind}_fold{fold}"
    return os.path.join(options.work, "runs", name if seed == 1 else f"{name}_seed{seed}")


def runs_named(options, pattern):
    """Trained runs by their folders' names."""
    return sorted(filter(is_trained, glob.glob(os.path.join(glob.escape(options.work), "runs", pattern))))


def is_trained(run):
    return os.path.exists(os.path.join(run, "state.pt"))


def folds_of(options):
    import numpy as np
    from makers import MADE_PEOPLE, folds

    makers = Counter()
    for path in glob.glob(os.path.join(glob.escape(prepared(options)), "*.npz")):
        with np.load(path) as file:
            makers[str(file["maker"])] += not file["report_only"] and not str(file["source"]).startswith(MADE_PEOPLE)
    return folds({maker: count for maker, count in makers.items() if count}, FOLDS)


def do_prepare(options):
    from prepare import prepare

    prepare(options.data, prepared(options), options.limber, options.labels, options.only, options.limit, options.again)
    people = os.path.join(options.work, "people")
    if os.path.isdir(people):
        prepare(people, prepared(options), options.limber, options.labels, options.only, options.limit, options.again)


def do_make(options):
    maker = os.path.join(HERE, "made_bodies.py")
    if os.path.exists(maker):
        subprocess.run([sys.executable, maker, os.path.join(options.work, "made"), str(options.count)], check=True)
    generator = os.path.join(options.data, "made_people", "makehuman_synth.py")
    if options.people and os.path.exists(generator):
        out = os.path.join(options.work, "people", "made_people")
        os.makedirs(out, exist_ok=True)
        subprocess.run([sys.executable, generator, out, str(options.people), "--seed", "1"], check=True)


def do_train(options):
    from train import Options, train

    leave_out = list(options.leave_out)
    if options.fold is not None:
        leave_out += folds_of(options)[options.fold]
        print("leaves out", ", ".join(leave_out))
    run = options.run or run_folder(options, options.kind, options.fold, options.seed)
    train(Options(
        kind=options.kind, data=prepared(options), made=os.path.join(options.work, "made"), run=run,
        leave_out=leave_out, samples=options.samples, batch=options.batch, rate=options.rate, threads=options.threads,
        samplers=options.samplers, seed=options.seed, bodies=options.bodies, minutes=options.minutes,
        device=options.device, start=options.start))


def trained_folds(options):
    found = [fold for fold in range(FOLDS) if is_trained(run_folder(options, "reading", fold))]
    if not found:
        raise SystemExit("no fold is trained: learn.py train reading --fold 0")
    return found


def calibration_of(options):
    path = os.path.join(options.work, "calibration.json")
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def do_evaluate(options):
    from evaluate import evaluate_run, load_rows
    from tables import report

    curves = runs_named(options, "reading_curve*")  # read by the step curve
    runs = options.run or [run for run in runs_named(options, "reading*") if run not in curves]
    if not options.kept:
        for run in runs:
            stance = os.path.join(os.path.dirname(run), os.path.basename(run).replace("reading", "stance"))
            print("reading what", os.path.basename(run), "was not trained on", flush=True)
            has_stance = stance != run and is_trained(stance)
            evaluate_run(run, prepared(options), stance if has_stance else None, limit=options.limit or 0)
    judged = options.run or [run_folder(options, "reading", fold) for fold in trained_folds(options)]
    text = report(load_rows(judged), calibration_of(options))
    with open(os.path.join(options.work, "tables.md"), "w", encoding="utf-8") as file:
        file.write(text)
    print(text)


def do_calibrate(options):
    from calibrate import calibrate
    from evaluate import load_rows

    result = calibrate(load_rows([run_folder(options, "reading", fold) for fold in trained_folds(options)]))
    with open(os.path.join(options.work, "calibration.json"), "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
    print(json.dumps(result))


def do_export(options):
    from body import load_bodies
    from export import blend, is_weights_file, network_of, read_weights, trained_for, write_golden, write_weights

    networks, cost = {}, {}
    for kind, source in (("reading", options.reading), ("stance", options.stance)):
        source = source or run_folder(options, kind)
        if is_weights_file(source) or is_trained(source):
            networks[kind], cost[kind] = network_of(source, kind), trained_for(source, kind)
    if options.reading and is_weights_file(options.reading):
        raise SystemExit(f"{options.reading} is exported already: --reading is a run (train --start {options.reading})")
    if "reading" not in networks:
        raise SystemExit("no network is trained: learn.py train reading")
    calibration = calibration_of(options)
    if calibration is None:
        print("not calibrated (learn.py calibrate): confidence and errors are the network's own", file=sys.stderr)
    if "stance" not in networks:
        print("without a network for the stance (learn.py train stance), which limber asks for", file=sys.stderr)
    run = options.reading or run_folder(options, "reading")
    blend(networks["reading"][0], [network_of(other, "reading")[0] for other in options.mean_with])
    with open(os.path.join(run, "run.json"), encoding="utf-8") as file:
        about = json.load(file)
    card = {"seed": about["options"]["seed"], "data": {"bodies": about["bodies"], "plans": about["plans"]},
            "makers": about["makers"], "licences": about["licences"], "left_out": about["options"]["leave_out"],
            "samples": {kind: spent["samples"] for kind, spent in cost.items()},
            "hours": {kind: spent["hours"] for kind, spent in cost.items()},
            "calibrated_on": {name: calibration[name] for name in ("bodies", "makers")} if calibration else None}
    size = write_weights(options.file, networks, calibration, card)
    print(f"{options.file}: {size} bytes, networks {', '.join(networks)}")
    if options.golden:
        bodies = load_bodies(prepared(options))
        chosen = [b for b in bodies if b.name in options.golden_bodies] or bodies[:3]
        write_golden(options.golden, read_weights(options.file)[0], chosen)


def do_curve(options):
    from document import rows_left_out
    from evaluate import evaluate_run
    from tables import by_group, once, table
    from train import Options, train

    leave_out = folds_of(options)[options.fold or 0]
    for count in options.counts:
        run = os.path.join(options.work, "runs", f"reading_curve{count}")
        train(Options(data=prepared(options), made=os.path.join(options.work, "made"), run=run, leave_out=leave_out,
                      samples=options.samples, bodies=count, threads=options.threads, samplers=options.samplers,
                      seed=options.seed))
        evaluate_run(run, prepared(options))
        rows = once(rows_left_out(run))
        print(f"\n{count or 'all'} bodies\n" + table("group", by_group(rows)), flush=True)


def do_document(options):
    from document import SECTIONS, curve, has_rows, is_outdated, left_out, reported, rewrite, seeds, training

    whole = run_folder(options, "reading")
    folds = [run for run in (run_folder(options, "reading", fold) for fold in range(FOLDS)) if has_rows(run)]
    judged = [run for run in runs_named(options, "reading*") if has_rows(run)]
    curves = [run for run in judged if os.path.basename(run).startswith("reading_curve")]
    for run in filter(is_outdated, judged):
        print(os.path.basename(run), "was trained further since it was read: learn.py evaluate", file=sys.stderr)
    sections = dict.fromkeys(SECTIONS)
    if is_trained(whole):
        sections["training"] = training(whole)
    if folds:
        sections |= left_out(folds, calibration_of(options) or {})
    sections["reported"] = reported(folds, whole)
    sections["seeds"] = seeds([run for run in judged if run not in curves])
    sections["curve"] = curve(curves)
    unchanged = rewrite(options.page, sections)
    if unchanged:
        print("left as they are, since their runs are not trained and read:", ", ".join(unchanged))


def do_pictures(options):
    from document import rewrite
    from evaluate import about_run
    from network import load_network
    from pictures import Reading, choose, describe, sheets

    runs = options.run or [run_folder(options, "reading")]
    networks = {run: load_network(os.path.join(run, "state.pt"))[0] for run in runs}
    temperature = (calibration_of(options) or {}).get("plan_temperature", 1.0)
    chosen = choose(runs, prepared(options), options.count)
    readings = [Reading(body, networks[run], temperature) for body, run in chosen]
    if not readings:
        raise SystemExit("there is no body that these runs were not trained on")
    names = []
    for index, sheet in enumerate(sheets(readings)):
        names.append(f"reading_{index + 1}.png")
        path = os.path.join(options.out, names[-1])
        sheet.save(path, optimize=True)
        print(path, os.path.getsize(path), "bytes")
    seen = set.intersection(*(set(about_run(run)["makers"]) for run in runs))
    text = describe(readings, seen, names)
    print(text)
    if options.page:
        rewrite(options.page, {"pictures": text})


def do_folds(options):
    for index, makers in enumerate(folds_of(options)):
        print(index, ", ".join(makers))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", default=os.path.join(BESIDE, "learn_data"),
                        help="what is prepared and learned (%(default)s)")
    parser.add_argument("--data", default=os.environ.get("LIMBER_SHARED_DATA", os.path.join(BESIDE, "shared", "data")),
                        help="rigged models (%(default)s)")
    parser.add_argument("--limber", default=os.path.join(REPOSITORY, "build", "release", "limber"),
                        help="the program (%(default)s)")
    steps = parser.add_subparsers(dest="step", required=True)

    step = steps.add_parser("prepare", help="rigged files -> samples and labels")
    step.add_argument("--labels", nargs="*", default=[], help="further folders of labels set by hand")
    step.add_argument("--only", default="", help="files whose path has this in it")
    step.add_argument("--limit", type=int, help="at most so many files")
    step.add_argument("--again", action="store_true", help="also those that are prepared already")
    step.set_defaults(do=do_prepare)

    step = steps.add_parser("make", help="bodies made by code, and people by MakeHuman's data")
    step.add_argument("count", type=int)
    step.add_argument("--people", type=int, default=0, help="people by MakeHuman's data, to be prepared after this")
    step.set_defaults(do=do_make)

    step = steps.add_parser("train", help="train a network, or go on with it")
    step.add_argument("kind", choices=["reading", "stance"])
    step.add_argument("--fold", type=int, choices=range(FOLDS), help="leave out this fold's makers")
    step.add_argument("--leave-out", nargs="*", default=[], metavar="MAKER")
    step.add_argument("--run", help="folder of the run (runs/KIND, KIND_foldK, KIND_seedN of --work)")
    step.add_argument("--start", default="", help="a run, or a weights file, whose weights to start from")
    step.add_argument("--bodies", type=int, default=0, help="only so many of the real bodies")
    step.add_argument("--minutes", type=float, default=0, help="stop after so many; the same command goes on")
    step.add_argument("--batch", type=int, default=16)
    step.add_argument("--rate", type=float, default=2e-3, help="highest learning rate (%(default)s)")
    step.add_argument("--device", default="cpu", help="cpu or cuda; what torch was built with")
    _add_training(step, 1_000_000)
    step.set_defaults(do=do_train)

    step = steps.add_parser("evaluate", help="tables of makers left out")
    step.add_argument("--run", nargs="*", help="runs to judge (all that are trained; tables are of the folds)")
    step.add_argument("--kept", action="store_true", help="only print anew what was read last time")
    step.add_argument("--limit", type=int, help="at most so many bodies of each run")
    step.set_defaults(do=do_evaluate)

    steps.add_parser("calibrate", help="confidence from the folds").set_defaults(do=do_calibrate)

    step = steps.add_parser("export", help="write the weights file")
    step.add_argument("file")
    step.add_argument("--reading", help="run of the reading network")
    step.add_argument("--mean-with", nargs="*", default=[],
                      help="runs and weights files that it began from, whose weights it is averaged with")
    step.add_argument("--stance", help="run of the stance network, or a weights file that has it")
    step.add_argument("--golden", help="also write inputs and outputs of three bodies to this JSON file")
    step.add_argument("--golden-bodies", nargs="*", default=[], help="their names")
    step.set_defaults(do=do_export)

    step = steps.add_parser("curve", help="figures over the number of bodies")
    step.add_argument("--counts", type=int, nargs="*", default=[50, 150, 300, 0], help="0: all")
    step.add_argument("--fold", type=int, choices=range(FOLDS), default=0)
    _add_training(step, 20_000)
    step.set_defaults(do=do_curve)

    step = steps.add_parser("document", help="make the figures of docs/reading.md anew")
    step.add_argument("--page", default=PAGE, help="%(default)s")
    step.set_defaults(do=do_document)

    step = steps.add_parser("pictures", help="draw bodies that were not trained on, with what is said of them")
    step.add_argument("count", type=int, nargs="?", default=60)
    step.add_argument("--run", nargs="*", help="runs that read them (runs/reading); of folds the one without the maker")
    step.add_argument("--out", default=os.path.join(REPOSITORY, "docs", "images"), help="folder (%(default)s)")
    step.add_argument("--page", default=PAGE, help="page whose list is made anew (%(default)s); '' for none")
    step.set_defaults(do=do_pictures)

    steps.add_parser("folds", help="which makers each fold leaves out").set_defaults(do=do_folds)
    return parser.parse_args()


def _add_training(step, samples):
    step.add_argument("--samples", type=int, default=samples, help="samples in all (%(default)s)")
    step.add_argument("--threads", type=int, default=1, help="of torch (%(default)s)")
    step.add_argument("--samplers", type=int, default=1, help="processes that draw samples (%(default)s)")
    step.add_argument("--seed", type=int, default=1)


if __name__ == "__main__":
    chosen = arguments()
    chosen.do(chosen)
