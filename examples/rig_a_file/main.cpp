// rig_a_file MODEL RIGGED.glb: a named skeleton where the model is like one, else handles.
#include <cstdio>

#include <limber/limber.h>

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: rig_a_file MODEL RIGGED.glb\n"), 2;
  try {
    limber::Asset model = limber::readAsset(argv[1]);
    limber::AutoRigOptions options;
    options.rigger = "template";        // of riggerMethods()
    options.skinning = "bone-heat";     // of weightMethods()
    options.rig.templateName = "auto";  // the one that fits best
    options.weights.maxInfluences = 4;

    // Stage and fraction as they come; progress.cancel() from any thread stops the work.
    limber::Progress progress([](std::string_view stage, double fraction) {
      std::fprintf(stderr, "\r%-30.*s %3.0f %%", static_cast<int>(stage.size()), stage.data(), 100 * fraction);
    });
    const limber::AutoRigReport report = limber::autoRig(model, options, progress);
    std::fprintf(stderr, "\n");
    limber::writeAsset(model, argv[2]);

    std::printf("%u joints", report.joints);
    if (!report.matches.empty()) {
      std::printf(", %s (%.0f %% sure)", report.matches.front().name.c_str(), 100 * report.matches.front().confidence);
    }
    std::printf("\n");
    for (const limber::Warning& warning : report.warnings.items()) {
      std::printf("warning: %s\n", limber::warningText(warning).c_str());
    }
  } catch (const limber::Error& error) {  // what, where and what to do
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
