#include "limber/actions/rig/rig_request.h"

#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "source_folder.h"

namespace limber {

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Error rigRefusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "nothing is refused";
  return {ErrorCode::kFile, ""};
}

Error rigRefusal(const RigRequest& request) {
  return rigRefusal([&] { optionsOf(request); });
}

using Change = std::function<void(RigRequest&)>;

// Every option, made to differ from what it is where nobody asks.
struct NamedChange {
  const char* option;
  Change change;
};
const std::vector<NamedChange>& templateOptions() {
  static const std::vector<NamedChange> options = {
      {"`pins`",
       [](RigRequest& r) {
         r.pins = {{"head", Vec3(0, 1, 0)}};
       }},
      {"`up`", [](RigRequest& r) { r.up = "+z"; }},
      {"`front`", [](RigRequest& r) { r.front = "x"; }},
      {"`upright`", [](RigRequest& r) { r.upright = true; }},
      {"`chains`", [](RigRequest& r) { r.chains = true; }},
  };
  return options;
}

}  // namespace

TEST(RigRequest, AsksForTheUsualWhereNothingIsSaid) {
  for (const RigRequest& request : {RigRequest(), rigRequestFromJson("{}")}) {
    const AutoRigOptions options = optionsOf(request), usual;
    EXPECT_EQ(options.rigger, usual.rigger);
    EXPECT_EQ(options.skinning, usual.skinning);
    EXPECT_EQ(options.weights.maxInfluences, usual.weights.maxInfluences);
    EXPECT_EQ(options.weights.pieces, usual.weights.pieces);
    EXPECT_EQ(options.existingRig, usual.existingRig);
    EXPECT_EQ(options.rig.handles, usual.rig.handles);
    EXPECT_EQ(options.rig.templateName, usual.rig.templateName);
    EXPECT_FALSE(options.rig.up || options.rig.front || options.rig.templateSkeleton || options.chains ||
                 options.standUpright);
    EXPECT_TRUE(options.rig.pins.empty());
  }
}

TEST(RigRequest, KnowsTheTargets) {
  EXPECT_EQ(rigRequestFromJson("{}").target, "gltf");
  EXPECT_EQ(rigRequestFromJson(R"({"target": "godot"})").target, "godot");
  RigRequest request;
  request.target = "maya";
  const Error error = rigRefusal(request);
  EXPECT_EQ(error.where(), "`target`");
  EXPECT_THAT(error.remedy(), HasSubstr("unreal"));
}

TEST(RigRequest, ReadsEveryOptionOfJson) {
  const AutoRigOptions fitted = optionsOf(rigRequestFromJson(R"({"template": "humanoid", "maxInfluences": 8,
      "skinning": "envelopes", "pieces": "soft", "existingRig": "replace", "up": "-Z", "front": "+x",
      "pins": {"head": [0, 1.5, -2], "hips": [1, 2, 3]}, "upright": true, "chains": true})"));
  EXPECT_EQ(fitted.rigger, "template");
  EXPECT_EQ(fitted.rig.templateName, "humanoid");
  EXPECT_EQ(fitted.weights.maxInfluences, 8u);
  EXPECT_EQ(fitted.skinning, "envelopes");
  EXPECT_EQ(fitted.weights.pieces, PieceMode::kSoft);
  EXPECT_EQ(fitted.existingRig, ExistingRig::kReplace);
  EXPECT_EQ(fitted.rig.up.value(), Vec3(0, 0, -1));
  EXPECT_EQ(fitted.rig.front.value(), Vec3(1, 0, 0));
  ASSERT_EQ(fitted.rig.pins.size(), 2u);
  EXPECT_EQ(fitted.rig.pins[0].joint, "head");
  EXPECT_EQ(fitted.rig.pins[0].position, Vec3(0, 1.5, -2));
  EXPECT_TRUE(fitted.standUpright && fitted.chains);

  const AutoRigOptions handles = optionsOf(rigRequestFromJson(R"({"rigger": "curve-skeleton", "handles": 7})"));
  EXPECT_EQ(handles.rigger, "curve-skeleton");
  EXPECT_EQ(handles.rig.handles, Index{7});
}

TEST(RigRequest, RefusesOtherJsonByTheOption) {
  struct Wrong {
    const char *json, *where, *message;
  };
  for (const auto& [json, where, message] : std::vector<Wrong>{
           {R"({"handels": 3})", "handels", "no such option"},
           {R"({"max-influences": 3})", "max-influences", "no such option"},
           {R"({"handles": "many"})", "`handles`", "must be a number"},
           {R"({"handles": -1})", "`handles`", "whole number"},
           {R"({"handles": 2.5})", "`handles`", "whole number"},
           {R"({"handles": 4294967301})", "`handles`", "4294967301"},
           {R"({"maxInfluences": []})", "`max-influences`", "must be a number"},
           {R"({"existingRig": 1})", "`existing-rig`", "must be a string"},
           {R"({"chains": 1})", "`chains`", "must be true or false"},
           {R"({"pins": [1, 2, 3]})", "`pins`", "must be an object"},
           {R"({"pins": {"head": [1, 2]}})", "`pins`", "head is not a position"},
           {R"({"pins": {"head": [1, 2, null]}})", "`pins`", "head[2] must be a number"},
           {R"({"rigger": null})", "`rigger`", "must be a string"},
           {R"({"template": null})", "`template`", "must be a string"},
           {"[]", "options", "must be an object"},
           {"{", "options", ""},
       }) {
    const Error error = rigRefusal([text = json] { rigRequestFromJson(text); });
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument) << json;
    EXPECT_EQ(error.where(), where) << json;
    EXPECT_THAT(error.message(), HasSubstr(message)) << json;
  }
  EXPECT_THAT(rigRefusal([] { rigRequestFromJson(R"({"handels": 3})"); }).remedy(),
              AllOf(HasSubstr("`handles`"), HasSubstr("`max-influences`")));
}

TEST(RigRequest, ReadsATemplateOnceAllElseIsRight) {
  const std::function<Skeleton()> unread = []() -> Skeleton {
    ADD_FAILURE() << "read too early";
    return {};
  };
  RigRequest wrong;
  wrong.maxInfluences = 9;
  EXPECT_EQ(rigRefusal([&] { optionsWithOwnTemplate(wrong, "own.json", unread); }).where(), "`max-influences`");
  EXPECT_EQ(rigRefusal([&] { optionsWithTemplate(wrong, "nowhere.json"); }).where(), "`max-influences`");
  EXPECT_THAT(rigRefusal([&] { optionsWithTemplate({}, "nowhere.json"); }).where(), HasSubstr("nowhere.json"));
  EXPECT_EQ(rigRefusal([&] { optionsWithTemplate({}, "nobody"); }).where(), "`template`");

  const AutoRigOptions named = optionsWithTemplate({}, "humanoid");
  EXPECT_EQ(named.rig.templateName, "humanoid");
  EXPECT_FALSE(named.rig.templateSkeleton);
  const AutoRigOptions own = optionsWithOwnTemplate({}, "own.json", [] {
    Skeleton skeleton;
    skeleton.joints.emplace_back().name = "root";
    return skeleton;
  });
  EXPECT_EQ(own.rigger, "template");
  EXPECT_EQ(own.rig.templateName, "own.json");
  ASSERT_TRUE(own.rig.templateSkeleton);
  EXPECT_EQ(own.rig.templateSkeleton->joints[0].name, "root");
}

TEST(RigRequest, ReadsNetworksOnceAllElseIsRight) {
  RigRequest request;
  request.reading = "nowhere.lrd";
  EXPECT_EQ(rigRefusal(request).remedy(), "name one: `template: auto`");
  request.chosenTemplate = ChosenTemplate{"humanoid"};
  EXPECT_THAT(rigRefusal(request).where(), HasSubstr("nowhere.lrd"));
  request.up = "+w";
  EXPECT_EQ(rigRefusal(request).where(), "`up`");
  request.up.reset();
  request.reading = testing::sourceFolder() / "limber/reading/data/shapes.lrd";
  EXPECT_TRUE(optionsOf(request).rig.reading);
  request.reading.reset();
  EXPECT_FALSE(optionsOf(request).rig.reading);
  request.chosenTemplate.reset();
  request.existingRig = "keep-skeleton";
  request.reading = "nowhere.lrd";
  EXPECT_EQ(rigRefusal(request).where(), "`reading`");
}

TEST(RigRequest, RefusesWhatDoesNotGoTogether) {
  RigRequest kept;
  kept.existingRig = "keep-skeleton";
  std::vector<NamedChange> ofJoints = templateOptions();
  ofJoints.push_back({"`handles`", [](RigRequest& r) { r.handles = 3; }});
  ofJoints.push_back({"`rigger`", [](RigRequest& r) { r.rigger = "prop"; }});
  ofJoints.push_back({"`template`", [](RigRequest& r) { r.chosenTemplate = ChosenTemplate{"auto"}; }});
  for (const auto& [option, change] : ofJoints) {
    RigRequest request = kept;
    change(request);
    EXPECT_EQ(rigRefusal(request).where(), option);
  }
  for (const auto& [option, change] : templateOptions()) {
    RigRequest request;
    change(request);
    EXPECT_EQ(rigRefusal(request).where(), option);
    EXPECT_EQ(rigRefusal(request).remedy(), "name one: `template: auto`");
    request.rigger = "template";
    EXPECT_EQ(optionsOf(request).rigger, "template");
    request.rigger.reset();
    request.chosenTemplate = ChosenTemplate{"humanoid"};
    EXPECT_EQ(optionsOf(request).rigger, "template");
    request.handles = 3;
    EXPECT_EQ(rigRefusal(request).where(), "`handles`");
  }
  RigRequest both;
  both.chosenTemplate = ChosenTemplate{"humanoid"};
  both.rigger = "prop";
  EXPECT_EQ(rigRefusal(both).where(), "`template`");
  both.rigger = "template";
  EXPECT_EQ(optionsOf(both).rig.templateName, "humanoid");
}

TEST(RigRequest, RefusesWhatIsOutOfRange) {
  for (const NamedChange& wrong : std::vector<NamedChange>{
           {"`handles`", [](RigRequest& r) { r.handles = 0; }},
           {"`handles`", [](RigRequest& r) { r.handles = kNoIndex; }},
           {"`max-influences`", [](RigRequest& r) { r.maxInfluences = 0; }},
           {"`max-influences`", [](RigRequest& r) { r.maxInfluences = 9; }},
           {"`existing-rig`", [](RigRequest& r) { r.existingRig = "keep"; }},
           {"`up`", [](RigRequest& r) { r.chosenTemplate = ChosenTemplate{"auto"}, r.up = "++y"; }},
           {"`front`", [](RigRequest& r) { r.chosenTemplate = ChosenTemplate{"auto"}, r.front = "w"; }},
           {"`front`", [](RigRequest& r) { r.chosenTemplate = ChosenTemplate{"auto"}, r.up = "+y", r.front = "-y"; }},
           {"`pins`",
            [](RigRequest& r) {
              r.chosenTemplate = ChosenTemplate{"auto"};
              r.pins = {{"head", Vec3(0, std::numeric_limits<double>::infinity(), 0)}};
            }},
           {"`up`", [](RigRequest& r) { r.chosenTemplate = ChosenTemplate{"auto"}, r.up = ""; }},
           {"`front`", [](RigRequest& r) { r.chosenTemplate = ChosenTemplate{"auto"}, r.front = ""; }},
           {"`template`", [](RigRequest& r) { r.chosenTemplate = ChosenTemplate{"nobody"}; }},
           {"`template`", [](RigRequest& r) { r.chosenTemplate = ChosenTemplate{""}; }},
           {"`pieces`", [](RigRequest& r) { r.pieces = "nobody"; }},
       }) {
    RigRequest request;
    wrong.change(request);
    const Error error = rigRefusal(request);
    EXPECT_EQ(error.where(), wrong.option);
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
  }
}

}  // namespace limber
