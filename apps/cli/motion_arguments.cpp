#include "motion_arguments.h"

#include "limber/document/smpl/smpl_arrays.h"
#include "limber/document/smpl/smpl_skeleton.h"

namespace limber::cli {

namespace {

std::shared_ptr<const NpzFiles> readBody(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  const auto body = std::make_shared<const NpzFiles>(readSmplArrays(readFile(path), name));
  try {
    smplSkeleton(*body, smplVertices(*body));
  } catch (const Error& error) {
    throw error.within(name);
  }
  return body;
}

}  // namespace

void MotionArguments::addTo(CLI::App& command) {
  command.add_option("--up", up, "which axis of a BVH or .npz points up; auto infers y or z from heads and feet")
      ->check(CLI::IsMember({"auto", "y", "z", "-y", "-z"}))
      ->type_name("AXIS")
      ->capture_default_str();
  command
      .add_option("--body", body,
                  "the SMPL model (.npz) whose joints a motion in SMPL's form is of; without it a person of our own")
      ->type_name("FILE");
}

MotionOptions MotionArguments::options() const {
  MotionOptions options;
  options.bvh.up = options.smpl.up = upAxisNamed(up);
  if (!body.empty()) options.smpl.body = readBody(body);
  return options;
}

}  // namespace limber::cli
