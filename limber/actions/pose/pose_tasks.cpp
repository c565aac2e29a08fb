#include "limber/actions/pose/pose_tasks.h"

#include <cmath>

#include <fmt/format.h>

#include "limber/actions/edit_text.h"
#include "limber/character/anatomy/anatomy.h"
#include "limber/core/error.h"
#include "limber/core/text/names.h"
#include "limber/core/text/numbers.h"
#include "limber/core/text/parse_number.h"
#include "limber/core/text/split_text.h"

namespace limber {

namespace {

const TaskForm& formOf(TaskKind kind) {
  return taskForms()[static_cast<std::size_t>(kind)];
}

// One task as it is read off its text: "KIND:JOINT=VALUE".
class TaskText {
 public:
  explicit TaskText(std::string_view text) : text_(text) {}

  TaskEdit parse() {
    std::string_view body = takeSuffix(text_);
    const std::size_t colon = body.find_first_of(":="), equals = body.rfind('=');
    edit_.where = inQuotes(text_);
    edit_.kind = kindOf(body.substr(0, colon));
    if (equals == std::string_view::npos) fail("has no value");
    value_ = body.substr(equals + 1);
    if (colon < equals) edit_.joint = body.substr(colon + 1, equals - colon - 1);
    if (edit_.kind != TaskKind::kBalance && edit_.joint.empty()) fail("names no joint");
    readValue();
    return edit_;
  }

 private:
  [[noreturn]] void fail(std::string message) const {
    failText(text_, std::move(message), fmt::format("write {}", formOf(edit_.kind).form));
  }

  TaskKind kindOf(std::string_view name) const {
    try {
      return findTaskKind(name);
    } catch (const Error& error) {
      failText(text_, error.message(), error.remedy());
    }
  }

  // Reads "@weight=2,priority=1" off the end.
  std::string_view takeSuffix(std::string_view text) {
    const std::size_t at = text.rfind('@');
    if (at == std::string_view::npos) return text;
    const std::string_view suffix = text.substr(at + 1);
    if (!suffix.starts_with("weight=") && !suffix.starts_with("priority=")) return text;
    const auto refuse = [&](const char* what) {
      failText(text, what,
               fmt::format("write @weight=2,priority=1: a weight above 0, a whole priority from 0 (first) to {}",
                           kHighestPriority));
    };
    for (const std::string_view word : splitAt(suffix, ',')) {
      const std::size_t equals = word.find('=');
      const std::optional<double> number =
          equals == std::string_view::npos ? std::nullopt : finiteNumber(word.substr(equals + 1));
      if (!number) refuse("has no number after the '@'");
      if (word.substr(0, equals) == "weight") {
        if (!(*number > 0)) refuse("has a weight that is not above 0");
        edit_.weight = *number;
      } else if (word.substr(0, equals) == "priority") {
        if (!(*number >= 0 && *number <= kHighestPriority && *number == std::floor(*number))) {
          refuse("has a priority that cannot be");
        }
        edit_.priority = static_cast<int>(*number);
      } else {
        refuse("has something else than weight and priority after the '@'");
      }
    }
    return text.substr(0, at);
  }

  Vec3 point(std::string_view value) const {
    const std::vector<double> numbers = numbersOf(value, 3);
    if (numbers.empty()) fail("has no point after the '='");
    return {numbers[0], numbers[1], numbers[2]};
  }

  // "NAME:0.2", the number behind the last colon.
  std::string_view takeAmount(const char* what) {
    const std::size_t colon = value_.rfind(':');
    const std::optional<double> number =
        colon == std::string_view::npos ? std::nullopt : finiteNumber(value_.substr(colon + 1));
    if (!number) fail(what);
    edit_.amount = *number;
    return value_.substr(0, colon);
  }

  // "sphere:..." and the like: the numbers behind a word.
  std::vector<double> numbersBehind(std::string_view word, std::size_t count) const {
    if (!value_.starts_with(word) || value_.substr(word.size()).find(':') != 0) return {};
    return numbersOf(value_.substr(word.size() + 1), count);
  }

  void readValue() {
    switch (edit_.kind) {
      case TaskKind::kPosition:
      case TaskKind::kLookAt:
        edit_.point = point(value_);
        break;
      case TaskKind::kOrientation:
        readTurn();
        break;
      case TaskKind::kDistance: {
        const std::string_view from = takeAmount("has no distance behind the last ':'");
        const std::vector<double> numbers = numbersOf(from, 3);
        if (numbers.empty()) {
          edit_.other = from;
          if (from.empty()) fail("says no joint or point that the distance is from");
        } else {
          edit_.point = Vec3(numbers[0], numbers[1], numbers[2]);
        }
        break;
      }
      case TaskKind::kPlane: {
        edit_.exact = value_.starts_with("on");
        const std::vector<double> numbers = numbersBehind(edit_.exact ? "on" : "above", 4);
        if (numbers.empty()) fail("has no plane after the '='");
        edit_.axis = Vec3(numbers[0], numbers[1], numbers[2]);
        edit_.amount = numbers[3];
        break;
      }
      case TaskKind::kBalance:
        if (value_ != "within" && value_ != "centred") fail("is neither within nor centred");
        edit_.exact = value_ == "centred";
        if (!edit_.joint.empty()) {
          for (const std::string_view name : splitAt(edit_.joint, '+')) edit_.supports.emplace_back(name);
        }
        edit_.joint.clear();
        break;
      case TaskKind::kKeepOut: {
        std::vector<double> n = numbersBehind("capsule", 7);
        if (n.empty()) {
          n = numbersBehind("sphere", 4);
          if (n.empty()) fail("has no sphere or capsule after the '='");
          n.insert(n.begin(), n.begin(), n.begin() + 3);
        }
        edit_.point = Vec3(n[0], n[1], n[2]);
        edit_.end = Vec3(n[3], n[4], n[5]);
        edit_.amount = n[6];
        break;
      }
      case TaskKind::kCoupling:
        edit_.other = takeAmount("has no ratio behind the last ':'");
        if (edit_.other.empty()) fail("names no joint to follow");
        break;
    }
  }

  void readTurn() {
    for (const std::string_view word : splitAt(value_, ',')) {
      const bool axis = word.size() > 2 && word[0] >= 'x' && word[0] <= 'z' && word[1] == ':';
      const std::optional<double> degrees = axis ? finiteNumber(word.substr(2)) : std::nullopt;
      if (!degrees) fail("has no turn after the '='");
      edit_.turn = (Eigen::AngleAxisd(*degrees * kDegree, Vec3::Unit(word[0] - 'x')) * edit_.turn).normalized();
    }
  }

  std::string_view text_, value_;
  TaskEdit edit_;
};

std::vector<Index> feetOf(const Skeleton& skeleton) {
  std::vector<Index> feet;
  for (const Part& part : readAnatomy(skeleton).parts) {
    if (part.kind != PartKind::kLeg || part.joints.empty()) continue;
    feet.push_back(part.end.value_or(part.joints.back()));
    if (part.toes) feet.push_back(*part.toes);
  }
  return feet;
}

class TaskResolver {
 public:
  TaskResolver(const Skeleton& skeleton, const TaskEdit& edit) : skeleton_(skeleton), edit_(edit) {}

  IkTask resolve() const { return {goal(), edit_.weight, edit_.priority}; }

 private:
  [[noreturn]] void fail(std::string message, std::string remedy = {}) const {
    throw Error(ErrorCode::kBadArgument, std::move(message), edit_.where, std::move(remedy));
  }
  Index joint(const std::string& name) const { return requireJoint(skeleton_, name, edit_.where); }
  Quat restRotation(Index joint) const { return decompose(restGlobals(skeleton_)[joint]).rotation; }
  double atLeast(double least, const char* what) const {
    if (!(edit_.amount >= least)) fail(what);
    return edit_.amount;
  }

  IkTaskGoal goal() const {
    switch (edit_.kind) {
      case TaskKind::kPosition:
        return PositionTask{joint(edit_.joint), edit_.point};
      case TaskKind::kOrientation: {
        const Index at = joint(edit_.joint);
        return OrientationTask{at, (edit_.turn * restRotation(at)).normalized()};
      }
      case TaskKind::kLookAt: {
        const Index at = joint(edit_.joint);
        const Vec3 axis = edit_.axis ? *edit_.axis : readAnatomy(skeleton_).axes.front;
        if (!(axis.stableNorm() > 0)) fail("has an axis of length 0");
        return LookAtTask{at, edit_.point, restRotation(at).conjugate() * axis.stableNormalized()};
      }
      case TaskKind::kDistance: {
        DistanceTask task{joint(edit_.joint), edit_.point, atLeast(0, "has a distance below 0")};
        if (!edit_.other.empty()) task.from = joint(edit_.other);
        if (!edit_.other.empty() && std::get<Index>(task.from) == task.joint)
          fail("is the distance of a joint from itself");
        return task;
      }
      case TaskKind::kPlane: {
        const Vec3 normal = edit_.axis.value_or(Vec3::UnitY());
        if (!(normal.stableNorm() > 0)) fail("has a normal of length 0");
        return PlaneTask{joint(edit_.joint), normal.stableNormalized(), edit_.amount, !edit_.exact};
      }
      case TaskKind::kBalance: {
        BalanceTask task{{}, edit_.exact};
        for (const std::string& name : edit_.supports) task.supports.push_back(joint(name));
        if (task.supports.empty()) task.supports = feetOf(skeleton_);
        if (task.supports.empty()) fail("needs feet, and none are found", "name them: balance:JOINT+JOINT=within");
        return task;
      }
      case TaskKind::kKeepOut:
        if (!(edit_.amount > 0)) fail("has a radius that is not above 0");
        return KeepOutTask{joint(edit_.joint), edit_.point, edit_.end, edit_.amount};
      case TaskKind::kCoupling:
        break;
    }
    const CouplingTask task{joint(edit_.joint), joint(edit_.other), edit_.amount};
    if (task.joint == task.leader) fail("couples a joint to itself");
    return task;
  }

  const Skeleton& skeleton_;
  const TaskEdit& edit_;
};

std::string_view obstacleText(IkTaskObstacle obstacle) {
  switch (obstacle) {
    case IkTaskObstacle::kTooFar:
      return "the bones are too short";
    case IkTaskObstacle::kLimits:
      return "the joints' limits are in the way";
    case IkTaskObstacle::kOtherTasks:
      return "other tasks are in the way";
    case IkTaskObstacle::kNone:
    case IkTaskObstacle::kUnknown:
      break;
  }
  return "no pose was found that meets it, even alone";
}

}  // namespace

TaskEdit parseTask(std::string_view text) {
  return TaskText(text).parse();
}

const std::vector<TaskForm>& taskForms() {
  static const std::vector<TaskForm> kForms = {
      {"position", "position:JOINT=x,y,z", "the joint is there"},
      {"orientation", "orientation:JOINT=y:30", "it is turned so from the rest pose, as --turn; y:0 keeps it"},
      {"look-at", "look-at:JOINT=x,y,z", "its front looks at the point"},
      {"distance", "distance:JOINT=JOINT:0.2 or distance:JOINT=x,y,z:0.2", "so far from a joint or a point"},
      {"plane", "plane:JOINT=above:0,1,0,0.1 or plane:JOINT=on:0,1,0,0.1",
       "above or on the plane of that normal, so far from the origin"},
      {"balance", "balance=within, balance=centred or balance:JOINT+JOINT=within",
       "the centre of mass over the feet, or over these joints"},
      {"keep-out", "keep-out:JOINT=sphere:x,y,z,radius or keep-out:JOINT=capsule:x,y,z,x,y,z,radius",
       "out of a sphere, or of a capsule round a segment"},
      {"coupling", "coupling:JOINT=LEADER:0.5", "turned half as far from the rest pose as the leader"},
  };
  return kForms;
}

TaskKind findTaskKind(std::string_view name) {
  const TaskForm& form = findByName(taskForms(), "kind of task", name);
  return static_cast<TaskKind>(&form - taskForms().data());
}

std::vector<IkTask> resolveTasks(const Skeleton& skeleton, const std::vector<TaskEdit>& edits) {
  std::vector<IkTask> tasks;
  for (const TaskEdit& edit : edits) tasks.push_back(TaskResolver(skeleton, edit).resolve());
  return tasks;
}

IkTaskResult applyTasks(const Skeleton& skeleton, Pose& pose, const std::vector<TaskEdit>& edits,
                        const JointLimits* limits, const IkTaskOptions& options) {
  return solveIkTasks(skeleton, pose, resolveTasks(skeleton, edits), limits, options);
}

std::string taskOutcome(const IkTaskReport& report) {
  if (report.met) return "met";
  const std::string left = report.isAngle ? fmt::format("{:.2f} degrees", report.residual / kDegree)
                                          : fmt::format("{:.4f} m", report.residual);
  return fmt::format("not met, {} left: {}", left, obstacleText(report.obstacle));
}

}  // namespace limber
