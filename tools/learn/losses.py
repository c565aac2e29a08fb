"""What training minimises."""
import torch
import torch.nn.functional as F

WEIGHTS = {"joint": 4.0, "error": 0.05, "has": 1.0, "part": 0.5, "plan": 0.3, "fingers": 0.2, "bone": 1.0}
CORNER = 0.1  # error at which the loss of a position goes from squared to linear, of the body's scale


def smooth(error):
    return torch.where(error < CORNER, error * error / (2 * CORNER), error - CORNER / 2)


def masked_mean(values, mask):
    return (values * mask).sum() / mask.sum().clamp(min=1)


def reading_losses(said, truth):
    """name -> loss, and the mean error of joints as `off`, which is only printed."""
    has = truth["has"]
    error = (said["y"] - truth["y"]).norm(dim=-1)
    sigma = said["sig"]
    finger = truth["fingers"].reshape(-1)
    bone = (said["bone"] - truth["bone"]).reshape(*truth["bone"].shape[:2], 2, 3).norm(dim=-1).mean(-1)
    known = (finger >= 0).float()
    count = F.cross_entropy(said["fingers"].reshape(len(finger), -1), finger.clamp(min=0), reduction="none")
    losses = {
        "joint": masked_mean(smooth(error), has),
        "error": masked_mean(error.detach() * torch.exp(-sigma) + sigma, has),
        "has": F.binary_cross_entropy_with_logits(said["has"], has),
        "part": F.cross_entropy(said["part"].transpose(1, 2), truth["part"]),
        "plan": F.cross_entropy(said["plan"], truth["plan"]),
        "fingers": masked_mean(count, known),
        "bone": masked_mean(smooth(bone), truth["bone_known"]),
    }
    return losses, masked_mean(error, has).detach()


def total(losses):
    return sum(WEIGHTS.get(name, 1.0) * loss for name, loss in losses.items())
