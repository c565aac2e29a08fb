#include "limber/evaluate/skin/weight_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/counted.h"

namespace limber {

Json toJson(const WeightComparison& c) {
  return {{"vertices", c.vertices},
          {"unpaired_vertices", c.unpairedVertices},
          {"order_kept", c.orderKept},
          {"joints", c.joints},
          {"used_joints", c.usedJoints},
          {"unpaired_joints", c.unpairedJoints},
          {"l1", c.l1},
          {"precision", c.precision},
          {"recall", c.recall},
          {"deform_mean", c.deformMean},
          {"deform_p95", c.deformP95},
          {"smoothness", c.smoothness},
          {"truth_smoothness", c.truthSmoothness},
          {"unweighted", c.unweighted},
          {"truth_unweighted", c.truthUnweighted}};
}

std::string toText(const WeightComparison& c) {
  std::string text =
      fmt::format("vertices      {} compared, paired by {}", c.vertices, c.orderKept ? "order" : "position and normal");
  if (c.unpairedVertices > 0) text += fmt::format("; {} without a counterpart left out", c.unpairedVertices);
  text += fmt::format("\njoints        {}, of which {} hold vertices", c.joints, c.usedJoints);
  if (c.unpairedJoints > 0) text += fmt::format("; {} of the result have no counterpart", c.unpairedJoints);
  text += fmt::format("\nL1            {:.3f} (0 the same, 2 nothing in common)", c.l1);
  text += fmt::format("\ninfluences    precision {:.3f}, recall {:.3f}", c.precision, c.recall);
  text +=
      fmt::format("\ndeformation   mean {:.3f} %, 95th percentile {:.3f} % of the diagonal", c.deformMean, c.deformP95);
  text += fmt::format("\nsmoothness    {:.3f} (truth {:.3f})", c.smoothness, c.truthSmoothness);
  text +=
      fmt::format("\nleft out      {} (truth {})\n", counted(c.unweighted, "vertex", "vertices"), c.truthUnweighted);
  return text;
}

}  // namespace limber
