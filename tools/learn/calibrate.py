"""Two numbers that make the networks' confidence true on makers that they have not seen, and a threshold.

plan_temperature: what logits of plans are divided by, for the least negative log likelihood. error_factor: what
expected errors are multiplied by, the mean of true over expected error (the most likely scale of Laplace's
distribution). sure_threshold: the least confidence above which at most one in fifty readings of the plan is wrong.
Files to report only are not looked at.
"""
import numpy as np
from scipy.optimize import minimize_scalar

from evaluate import confidence, kind_right

ALLOWED_WRONG = 0.02
THRESHOLDS = np.arange(0.5, 0.96, 0.05)
NO_CORRECTION = 0.1  # of 1, within which a number is left at 1: folds trained for less time than all makers' networks


def _correction(value):
    return 1.0 if abs(value - 1) < NO_CORRECTION else round(value, 4)


def calibrate(rows):
    rows = [row for row in rows if not row["report_only"]]
    if len(rows) < 10:
        raise SystemExit(f"{len(rows)} bodies of makers left out are too few to calibrate with: evaluate folds first")

    def loss(logarithm):
        return -np.mean([np.log(max(confidence(row, np.exp(logarithm))[row["plan"]], 1e-12)) for row in rows])

    temperature = float(np.exp(minimize_scalar(loss, bounds=(-2, 2), method="bounded").x))
    ratios = np.concatenate([np.array(row["error"]) / np.maximum(row["expected"], 1e-6) for row in rows])
    sure = np.array([confidence(row, temperature).max() for row in rows])
    right = np.array([kind_right(row) for row in rows])
    wrong = [1 - right[sure >= t].mean() if (sure >= t).any() else 1 for t in THRESHOLDS]
    threshold = next((t for t, fraction in zip(THRESHOLDS, wrong) if fraction <= ALLOWED_WRONG), THRESHOLDS[-1])
    return {
        "plan_temperature": _correction(temperature), "error_factor": _correction(float(ratios.mean())),
        "sure_threshold": round(float(threshold), 2), "bodies": len(rows),
        "makers": sorted({row["maker"] for row in rows}),
    }
