"""Trains one network: `reading` or `stance`. Can be stopped at any time and goes on from its last state.

A run is a folder: state.pt (weights, their running mean, the optimizer, how far it is), log.tsv, run.json (what was
asked for, which makers and how many bodies). The running mean is what is exported.
"""
import copy
import json
import os
import time
from collections import Counter
from dataclasses import asdict, dataclass, field
from queue import Empty

import numpy as np
import torch
import torch.multiprocessing as multiprocessing

import losses
import variation
import vocabulary as words
from body import load_bodies
from export import network_of
from makers import CODE
from network import STANCE_TOKENS, make_network

PART_TOKENS = 128  # tokens of a sample whose part and bone are learned
KEPT_STATES_EVERY = 180.0  # seconds
FIELDS = {"reading": ("inputs", "y", "has", "part", "bone", "bone_known", "plan", "fingers", "pin_roles", "pin_positions"),
          "stance": ("inputs",)}
WRONG_STANCES = 5  # of the 23, beside front for back, that a body is compared with at a time


@dataclass
class Options:
    kind: str = "reading"
    data: str = ""  # folder of prepared bodies
    made: str = ""  # folder of bodies made by code
    run: str = ""
    leave_out: list = field(default_factory=list)  # makers
    samples: int = 60000  # at whose end the learning rate is nearly 0; a finished run goes on no further
    batch: int = 16
    rate: float = 2e-3
    threads: int = 1
    samplers: int = 1
    seed: int = 1
    bodies: int = 0  # only so many of the real bodies, for the learning curve; 0: all
    minutes: float = 0  # stop (and keep the state) after so long; 0: when done
    device: str = "cpu"
    start: str = ""  # a run or a weights file whose weights this one starts from


def training_bodies(options):
    """Bodies to learn from: never those to report only, never a maker that is left out."""
    real = [b for b in load_bodies(options.data) if not b.report_only and b.maker not in options.leave_out]
    if options.bodies:
        chosen = np.random.RandomState(options.seed).permutation(len(real))[: options.bodies]
        real = [real[k] for k in sorted(chosen)]
    bodies = real + load_bodies(options.made, CODE)
    if options.kind == "stance":  # things that are no bodies have no front
        bodies = [b for b in bodies if b.plan != words.PLAN["none"]]
    return bodies


def odds(bodies):
    """How often each body is drawn: plans by the root of their number, of a plan the makers by the root of theirs."""
    of = [(b.plan, b.maker) for b in bodies]
    by_plan, by_both = Counter(plan for plan, _ in of), Counter(of)
    roots = {plan: sum(n**0.5 for (p, _), n in by_both.items() if p == plan) for plan in by_plan}
    result = np.array([by_plan[k[0]] ** 0.5 * by_both[k] ** 0.5 / roots[k[0]] / by_both[k] for k in of])
    return result / result.sum()


def _sampler(bodies, options, seed, queue):
    """Fills the queue with batches without end."""
    torch.set_num_threads(1)
    random, weights, fields = np.random.RandomState(seed), odds(bodies), FIELDS[options.kind]
    while True:
        drawn = random.choice(len(bodies), options.batch // 2, p=weights)
        batch = [variation.vary(bodies[k], random) for k in drawn]
        batch += [variation.mirrored(sample, random) for sample in batch]
        queue.put([np.stack([getattr(sample, name) for sample in batch]) for name in fields])


def _stance_loss(network, inputs):
    """Each body, which stands as it should, against itself with its front to the back and in some other stances."""
    right = words.UPRIGHT_STANCE
    back = int(np.argmin([np.abs(stance - np.diag([-1, 1, -1])).sum() for stance in words.STANCES]))
    others = [k for k in range(len(words.STANCES)) if k not in (right, back)]
    wrong = torch.stack([torch.randperm(len(others))[:WRONG_STANCES] for _ in inputs])
    stances = torch.tensor(others)[wrong]
    stances = torch.cat([torch.tensor([[right, back]]).expand(len(inputs), -1), stances], 1)
    turns = torch.from_numpy(words.STANCES.astype("f4")).to(inputs.device)[stances.to(inputs.device)]
    tokens = inputs[:, :STANCE_TOKENS]
    vectors = tokens[..., :9].reshape(*tokens.shape[:2], 3, 3)  # position, normal, ball's centre
    turned = torch.einsum("bsij,btvj->bstvi", turns, vectors).flatten(3)
    rest = tokens[:, None, :, 9:].expand(-1, turned.shape[1], -1, -1)
    scores = network(torch.cat([turned, rest], -1).flatten(0, 1)).view(len(inputs), -1)
    return torch.nn.functional.cross_entropy(scores, torch.zeros(len(inputs), dtype=torch.long, device=scores.device))


def _step_losses(network, kind, batch):
    if kind == "stance":
        return {"stance": _stance_loss(network, batch["inputs"])}, torch.zeros(())
    some = torch.randperm(batch["inputs"].shape[1])[:PART_TOKENS]
    for name in ("part", "bone", "bone_known"):
        batch[name] = batch[name][:, some]
    said = network(batch["inputs"], batch["pin_roles"], batch["pin_positions"], some)
    return losses.reading_losses(said, batch)


def _next(queues, samplers, step):
    """The next batch; raises where the process that should draw it has ended."""
    k = step % len(queues)
    while True:
        try:
            return queues[k].get(timeout=10)
        except Empty:
            if not samplers[k].is_alive():
                raise RuntimeError("a process that draws samples has ended: see its error above")


class _Run:
    """Network, running mean and optimizer, and their state on disk."""

    def __init__(self, options):
        self.options = options
        self.path = os.path.join(options.run, "state.pt")
        torch.manual_seed(options.seed)
        self.network, self.sizes = make_network(options.kind)
        self.step, self.seconds = 0, 0.0
        self.steps = max(options.samples // options.batch, 1)
        if options.start:
            self.network.load_state_dict(network_of(options.start, options.kind)[0].state_dict())
        self.network.to(options.device)
        self.mean = copy.deepcopy(self.network)
        self.optimizer = torch.optim.AdamW(
            self.network.parameters(), lr=options.rate, weight_decay=0.02, betas=(0.9, 0.98))
        self.schedule = torch.optim.lr_scheduler.OneCycleLR(
            self.optimizer, options.rate, total_steps=self.steps + 1, pct_start=0.05, div_factor=10,
            final_div_factor=50)
        if os.path.exists(self.path):
            self._resume()

    def _resume(self):
        saved = torch.load(self.path, map_location=self.options.device)
        if saved["samples_planned"] != self.options.samples or saved["batch"] != self.options.batch:
            begun = f"--samples {saved['samples_planned']} --batch {saved['batch']}"
            raise SystemExit(f"{self.path} was begun with {begun}: go on with these, or begin another run (--start "
                             "takes its weights)")
        self.network.load_state_dict(saved["network"])
        self.mean.load_state_dict(saved["mean"])
        self.optimizer.load_state_dict(saved["optimizer"])
        self.schedule.load_state_dict(saved["schedule"])
        self.step, self.seconds = saved["step"], saved["seconds"]

    def save(self, seconds):
        saved = {
            "kind": self.options.kind, "sizes": self.sizes, "network": self.network.state_dict(),
            "mean": self.mean.state_dict(), "optimizer": self.optimizer.state_dict(),
            "schedule": self.schedule.state_dict(), "step": self.step,
            "seconds": self.seconds + seconds, "samples_planned": self.options.samples, "batch": self.options.batch,
        }
        torch.save(saved, self.path + ".part")
        os.replace(self.path + ".part", self.path)

    def advance(self, loss):
        self.optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self.optimizer.step()
        self.schedule.step()
        self.step += 1
        keep = min(0.998, self.step / (self.step + 20))
        with torch.no_grad():
            for mean, now in zip(self.mean.parameters(), self.network.parameters()):
                mean.mul_(keep).add_(now, alpha=1 - keep)


def _describe(options, bodies, network):
    plans = Counter(words.PLANS[b.plan] for b in bodies)
    makers = Counter(b.maker for b in bodies)
    licences = {maker: "; ".join(sorted({b.licence for b in bodies if b.maker == maker})) for maker in makers}
    about = {"options": asdict(options), "bodies": len(bodies), "plans": plans, "makers": makers, "licences": licences,
             "numbers": sum(p.numel() for p in network.parameters())}
    with open(os.path.join(options.run, "run.json"), "w", encoding="utf-8") as file:
        json.dump(about, file, indent=1)
    print(f"{options.kind}: {about['numbers']} numbers, {len(bodies)} bodies of {len(makers)} makers, {dict(plans)}",
          flush=True)


def train(options):
    os.makedirs(options.run, exist_ok=True)
    torch.set_num_threads(options.threads)
    bodies = training_bodies(options)
    if not bodies:
        raise SystemExit(f"no bodies in {options.data}: run `learn.py prepare` first")
    run = _Run(options)
    _describe(options, bodies, run.network)
    if run.step >= run.steps:
        print("already done")
        return
    context = multiprocessing.get_context("fork")
    queues = [context.Queue(4) for _ in range(options.samplers)]  # read in turn: the same samples in the same order
    seeds = [options.seed + 7919 * k + 104729 * (run.step + 1) for k in range(options.samplers)]
    samplers = [context.Process(target=_sampler, args=(bodies, options, seed % 2**32, queue), daemon=True)
                for seed, queue in zip(seeds, queues)]
    for sampler in samplers:
        sampler.start()
    try:
        _loop(run, queues, samplers)
    finally:
        for sampler in samplers:
            sampler.terminate()


def _loop(run, queues, samplers):
    options, started, kept, first = run.options, time.time(), time.time(), run.step
    recent = []
    with open(os.path.join(options.run, "log.tsv"), "a", encoding="utf-8") as log:
        while run.step < run.steps:
            arrays = _next(queues, samplers, run.step)
            batch = {name: torch.from_numpy(array).to(options.device) for name, array in zip(FIELDS[options.kind], arrays)}
            parts, off = _step_losses(run.network, options.kind, batch)
            run.advance(losses.total(parts))
            recent.append([float(value) for value in parts.values()] + [float(off)])
            stop = options.minutes and time.time() - started > 60 * options.minutes
            if run.step % 200 == 0 or run.step == run.steps or stop:
                means = "\t".join(f"{name} {value:.4f}" for name, value in zip([*parts, "off"], np.mean(recent, 0)))
                speed = (run.step - first) * options.batch / (time.time() - started)
                line = f"{run.step * options.batch}\t{means}\t{speed:.1f} samples/s"
                print(line, flush=True)
                log.write(line + "\n")
                log.flush()
                recent = []
            if time.time() - kept > KEPT_STATES_EVERY:
                run.save(time.time() - started)
                kept = time.time()
            if stop:
                break
    run.save(time.time() - started)
