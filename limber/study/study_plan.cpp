#include "limber/study/study_plan.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/actions/rig/rig_request.h"
#include "limber/adapters/adapter_folder.h"
#include "limber/adapters/job_limits.h"
#include "limber/core/text/names.h"
#include "limber/deform/deformer.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_keys.h"
#include "limber/motion/retarget/retarget_method.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/template_rigger.h"
#include "limber/rigging/weights/weight_method.h"
#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

namespace {

constexpr std::string_view kAll = "all", kVersionKey = "limber_study", kUsualSolver = "two-bone";
constexpr std::size_t kMaxThreads = 1024;

std::vector<std::string> textsOf(const JsonView& object, std::string_view key) {
  const JsonView list = object.array(key);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < list.size(); ++i) {
    texts.push_back(requiredText(list[i]));
    if (std::count(texts.begin(), texts.end(), texts.back()) > 1) list[i].fail("stands there twice");
  }
  return texts;
}

// Calls `check` for a name; its errors then name the entry of the plan.
template <typename Check>
void checkAt(const JsonView& value, const std::string& name, const Check& check) {
  try {
    check(name);
  } catch (const Error& error) {
    value.fail(error.remedy().empty() ? std::string(error.what()) : error.message() + "; " + error.remedy());
  }
}

// The methods that a list names; `byDefault` where it is missing.
template <typename Table, typename Check>
std::vector<std::string> methodsOf(const JsonView& object, std::string_view key, const Table& table,
                                   std::vector<std::string> byDefault, const Check& check) {
  const JsonView list = object.array(key);
  if (!list.exists()) return byDefault;
  std::vector<std::string> names = textsOf(object, key);
  if (names == std::vector<std::string>{std::string(kAll)}) {
    names.clear();
    for (const auto& method : table) names.emplace_back(method.name);
    return names;
  }
  for (std::size_t i = 0; i < names.size(); ++i) checkAt(list[i], names[i], check);
  return names;
}

// Methods of limber's by name, and programs of the user's where there is no such method.
class PlanMethods {
 public:
  explicit PlanMethods(const std::vector<std::filesystem::path>& adapterFolders) : folders_(adapterFolders) {}

  // Throw Error kBadArgument where nobody is called so.
  void checkRigger(std::string_view name) const {
    if (name != kOwnSkeleton && !adapterOf(name, AdapterKind::kRig)) findRigger(name);
  }
  void checkSkinning(std::string_view name) const {
    if (!adapterOf(name, AdapterKind::kWeights)) findWeightMethod(name);
  }
  void checkRetargeting(std::string_view name) const {
    if (!adapterOf(name, AdapterKind::kRetarget)) findRetargetMethod(name);
  }
  bool isProgram(std::string_view rigger) const { return adapterOf(rigger, AdapterKind::kRig).has_value(); }
  // By each solver, or by none where the method uses none, or is a program that decides for itself.
  std::vector<RetargetCombination> retargetCombinations(const std::string& method,
                                                        const std::vector<std::string>& solvers) const {
    if (const auto adapter = adapterOf(method, AdapterKind::kRetarget)) return {{method, {}, {adapter->file}}};
    if (!findRetargetMethod(method).usesSolver) return {{method, {}}};
    std::vector<RetargetCombination> combinations;
    for (const std::string& solver : solvers) combinations.push_back({method, solver});
    return combinations;
  }
  RigCombination combination(std::string rigger, std::string skinning, RigSetting setting) const {
    RigCombination one{std::move(rigger), std::move(skinning), std::move(setting)};
    for (const auto& adapter :
         {adapterOf(one.rigger, AdapterKind::kRig), adapterOf(one.skinning, AdapterKind::kWeights)}) {
      if (adapter) one.adapters.push_back(adapter->file);
    }
    return one;
  }

 private:
  static bool isOwn(std::string_view name, AdapterKind kind) {
    const auto isCalledSo = [&](const auto& method) { return method.name == name; };
    if (kind == AdapterKind::kWeights) {
      return std::any_of(weightMethods().begin(), weightMethods().end(), isCalledSo);
    }
    if (kind == AdapterKind::kRetarget) {
      return std::any_of(retargetMethods().begin(), retargetMethods().end(), isCalledSo);
    }
    return name == kOwnSkeleton || std::any_of(riggerMethods().begin(), riggerMethods().end(), isCalledSo);
  }
  std::optional<Adapter> adapterOf(std::string_view name, AdapterKind kind) const {
    if (isOwn(name, kind)) return std::nullopt;
    std::optional<Adapter> adapter = findAdapter(name, folders_);
    return adapter && adapter->kind == kind ? adapter : std::nullopt;
  }

  const std::vector<std::filesystem::path>& folders_;
};

RigSetting settingOf(const JsonView& entry) {
  entry.requireObject();
  allowKeys(entry, {"name", "handles", "max_influences", "pieces", "template"});
  RigSetting setting;
  setting.name = requiredText(entry.member("name"));
  const auto add = [&](std::string_view option, std::string value) {
    setting.arguments.insert(setting.arguments.end(), {std::string(option), std::move(value)});
  };
  if (const auto handles = entry.count("handles")) {
    if (*handles == 0) entry.member("handles").fail("is not at least 1");
    add("--handles", std::to_string(*handles));
  }
  if (const auto influences = entry.count("max_influences")) {
    if (*influences < 1 || *influences > 8) entry.member("max_influences").fail("is not from 1 to 8");
    add("--max-influences", std::to_string(*influences));
  }
  if (const JsonView pieces = entry.member("pieces"); pieces.exists()) {
    checkAt(pieces, requiredText(pieces), findPieceMode);
    add("--pieces", requiredText(pieces));
  }
  if (const JsonView name = entry.member("template"); name.exists()) {
    checkAt(name, requiredText(name), checkTemplateName);
    add("--template", requiredText(name));
  }
  return setting;
}

// `limber rig` refuses some options with some riggers; a plan with such a cell is refused before it runs.
void checkTogether(const JsonView& at, const RigCombination& one, const PlanMethods& methods) {
  const std::vector<std::string>& arguments = one.setting.arguments;
  const auto asksFor = [&](std::string_view option) {
    return std::find(arguments.begin(), arguments.end(), option) != arguments.end();
  };
  RigRequest request;
  if (one.rigger == kOwnSkeleton) {
    request.existingRig = "keep-skeleton";
  } else {
    request.rigger = one.rigger;
  }
  if (asksFor("--template")) request.chosenTemplate = ChosenTemplate{"auto"};
  if (asksFor("--handles")) request.handles = 1;
  std::string problem;
  try {
    optionsOf(request);
    if (request.handles && methods.isProgram(one.rigger)) problem = "a program makes as many joints as it does";
  } catch (const Error& error) {
    problem = error.message();
  }
  if (problem.empty()) return;
  at.fail(fmt::format("the options '{}' do not go with the rigger '{}': {}; name what does as 'pairs'",
                      one.setting.name, one.rigger, problem));
}

std::vector<RigSetting> settingsOf(const JsonView& rig) {
  const JsonView list = rig.array("options");
  std::vector<RigSetting> settings;
  for (std::size_t i = 0; i < list.size(); ++i) {
    settings.push_back(settingOf(list[i]));
    const auto isSame = [&](const RigSetting& s) { return s.name == settings.back().name; };
    if (std::count_if(settings.begin(), settings.end(), isSame) > 1) list[i].fail("has a name that is taken");
  }
  return settings;
}

// Pairs replace the lists that are multiplied out.
void refuseBeside(const JsonView& object, std::initializer_list<std::string_view> lists) {
  for (const std::string_view list : lists) {
    if (object.member(list).exists()) object.fail(fmt::format("has both 'pairs' and '{}'", list));
  }
}

// The plan's own combinations, instead of all.
std::vector<RigCombination> namedPairs(const JsonView& pairs, const std::vector<RigSetting>& settings,
                                       const PlanMethods& methods) {
  std::vector<RigCombination> combinations;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const JsonView pair = pairs[i];
    pair.requireObject();
    allowKeys(pair, {"rigger", "skinning", "deformer", "options"});
    const std::string rigger = requiredText(pair.member("rigger")), skinning = requiredText(pair.member("skinning"));
    checkAt(pair.member("rigger"), rigger, [&](const std::string& name) { methods.checkRigger(name); });
    checkAt(pair.member("skinning"), skinning, [&](const std::string& name) { methods.checkSkinning(name); });
    RigCombination one = methods.combination(rigger, skinning, {});
    if (const JsonView name = pair.member("options"); name.exists()) {
      const auto find = [&](const std::string& wanted) {
        one.setting = findByName(settings, "set of options", wanted);
      };
      checkAt(name, requiredText(name), find);
      checkTogether(name, one, methods);
    }
    if (const JsonView deformer = pair.member("deformer"); deformer.exists()) {
      one.deformer = requiredText(deformer);
      checkAt(deformer, one.deformer, findDeformer);
    }
    const auto isSame = [&](const RigCombination& other) {
      return std::tie(other.rigger, other.skinning, other.setting.name, other.deformer) ==
             std::tie(one.rigger, one.skinning, one.setting.name, one.deformer);
    };
    if (std::any_of(combinations.begin(), combinations.end(), isSame)) pair.fail("stands there twice");
    combinations.push_back(std::move(one));
  }
  return combinations;
}

// Every rigger with every skinning method, every set of options and every deformer.
std::vector<RigCombination> rigProduct(const JsonView& rig, std::vector<RigSetting> settings,
                                       const PlanMethods& methods) {
  if (settings.empty()) settings.emplace_back();
  const std::vector<std::string> riggers = methodsOf(rig, "riggers", riggerMethods(), {"template"},
                                                     [&](const std::string& name) { methods.checkRigger(name); });
  const std::vector<std::string> skinnings = methodsOf(rig, "skinning", weightMethods(), {"bone-heat"},
                                                       [&](const std::string& name) { methods.checkSkinning(name); });
  const std::vector<std::string> bendings = methodsOf(rig, "deformers", deformers(), {std::string()}, findDeformer);
  std::vector<RigCombination> combinations;
  for (const std::string& rigger : riggers) {
    for (const std::string& skinning : skinnings) {
      for (const RigSetting& setting : settings) {
        for (const std::string& deformer : bendings) {
          combinations.push_back(methods.combination(rigger, skinning, setting));
          checkTogether(rig.member("options"), combinations.back(), methods);
          combinations.back().deformer = deformer;
        }
      }
    }
  }
  return combinations;
}

RigPlan rigPlanOf(const JsonView& rig, const PlanMethods& methods) {
  RigPlan plan;
  if (!rig.exists()) return plan;
  allowKeys(rig, {"models", "riggers", "skinning", "deformers", "options", "pairs"});
  plan.models = textsOf(rig, "models");
  if (plan.models.empty()) rig.fail("names no models");
  const std::vector<RigSetting> settings = settingsOf(rig);
  if (const JsonView pairs = rig.array("pairs"); pairs.exists()) {
    refuseBeside(rig, {"riggers", "skinning", "deformers"});
    plan.combinations = namedPairs(pairs, settings, methods);
  } else {
    plan.combinations = rigProduct(rig, settings, methods);
  }
  if (plan.combinations.empty()) rig.fail("names no methods");
  return plan;
}

std::vector<RetargetCombination> retargetPairs(const JsonView& pairs, const PlanMethods& methods) {
  std::vector<RetargetCombination> combinations;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const JsonView pair = pairs[i];
    pair.requireObject();
    allowKeys(pair, {"method", "solver"});
    const std::string method = requiredText(pair.member("method"));
    checkAt(pair.member("method"), method, [&](const std::string& name) { methods.checkRetargeting(name); });
    const JsonView solver = pair.member("solver");
    if (solver.exists()) checkAt(solver, requiredText(solver), findIkMethod);
    RetargetCombination one =
        methods.retargetCombinations(method, {solver.exists() ? requiredText(solver) : std::string(kUsualSolver)})
            .front();
    if (solver.exists() && one.solver.empty()) {
      solver.fail(fmt::format("is of no use: '{}' uses no solver, but {}", method, retargetMethodsWithSolver()));
    }
    const auto isSame = [&](const RetargetCombination& other) {
      return other.method == one.method && other.solver == one.solver;
    };
    if (std::any_of(combinations.begin(), combinations.end(), isSame)) pair.fail("stands there twice");
    combinations.push_back(std::move(one));
  }
  return combinations;
}

// Every method with every solver.
std::vector<RetargetCombination> retargetProduct(const JsonView& retarget, const PlanMethods& methods) {
  const std::vector<std::string> names = methodsOf(retarget, "methods", retargetMethods(), {"limb-ik"},
                                                   [&](const std::string& name) { methods.checkRetargeting(name); });
  const std::vector<std::string> solvers =
      methodsOf(retarget, "solvers", ikMethods(), {std::string(kUsualSolver)}, findIkMethod);
  std::vector<RetargetCombination> combinations;
  for (const std::string& name : names) {
    for (RetargetCombination& one : methods.retargetCombinations(name, solvers)) combinations.push_back(std::move(one));
  }
  return combinations;
}

RetargetPlan retargetPlanOf(const JsonView& retarget, const PlanMethods& methods) {
  RetargetPlan plan;
  if (!retarget.exists()) return plan;
  allowKeys(retarget, {"characters", "motions", "methods", "solvers", "pairs"});
  plan.characters = textsOf(retarget, "characters");
  plan.motions = textsOf(retarget, "motions");
  if (plan.characters.empty()) retarget.fail("names no characters");
  if (plan.motions.empty()) retarget.fail("names no motions");
  if (const JsonView pairs = retarget.array("pairs"); pairs.exists()) {
    refuseBeside(retarget, {"methods", "solvers"});
    plan.combinations = retargetPairs(pairs, methods);
  } else {
    plan.combinations = retargetProduct(retarget, methods);
  }
  if (plan.combinations.empty()) retarget.fail("names no methods");
  return plan;
}

StudyPlan planOf(const JsonView& root, const PlanMethods& methods) {
  root.requireObject();
  if (root.count(kVersionKey) != 1) root.fail(fmt::format("has no \"{}\": 1", kVersionKey));
  allowKeys(root, {kVersionKey, "title", "rig", "retarget", "limits", "threads"});
  StudyPlan plan;
  if (root.member("title").exists()) plan.title = requiredText(root.member("title"));
  plan.rig = rigPlanOf(root.object("rig"), methods);
  plan.retarget = retargetPlanOf(root.object("retarget"), methods);
  readJobLimits(root.object("limits"), plan.limits);
  if (const auto threads = root.count("threads")) {
    if (*threads > kMaxThreads) root.member("threads").fail(fmt::format("is not from 0 to {}", kMaxThreads));
    plan.threads = static_cast<int>(*threads);
  }
  if (plan.rig.models.empty() && plan.retarget.characters.empty()) root.fail("has neither \"rig\" nor \"retarget\"");
  return plan;
}

}  // namespace

StudyPlan studyPlanFromJson(std::string_view text, const std::vector<std::filesystem::path>& adapterFolders) {
  try {
    const Json json = parseStrictly(text);
    return planOf(JsonView(json), PlanMethods(adapterFolders));
  } catch (const Error& error) {
    throw error.within("study plan");
  }
}

std::string exampleStudyPlan() {
  return R"({
  "limber_study": 1,
  "title": "Riggers and weights on samples",
  "rig": {
    "models": ["sample:biped", "sample:quadruped", "sample:flying"],
    "riggers": ["own", "template", "sphere-mesh"],
    "skinning": ["bone-heat", "geodesic-voxel"]
  },
  "retarget": {
    "characters": ["sample:flying"],
    "motions": ["sample:flap", "sample:trot"],
    "methods": ["limb-ik", "copy"],
    "solvers": ["two-bone", "fabrik"]
  },
  "limits": {"seconds": 60, "memory_mb": 2048},
  "threads": 1
}
)";
}

}  // namespace limber
