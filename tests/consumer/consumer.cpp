// Rigs a sample with the installed library.
#include <cstdio>

#include <limber/pipeline/auto_rig.h>
#include <limber/samples/samples.h>

int main() {
  limber::Asset model = limber::makeSample("biped");
  limber::AutoRigOptions options;
  options.rig.handles = 12;
  limber::Progress progress;
  std::printf("joints: %u\n", limber::autoRig(model, options, progress).joints);
}
