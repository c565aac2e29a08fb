// The two networks that read a shape, and what they say, in their own frame: centred and scaled
// (SurfaceSamples::toNetwork).
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"
#include "limber/reading/arithmetic.h"

namespace limber {

struct NetworkSizes {
  std::size_t width = 0;
  std::size_t layers = 0;
  std::size_t heads = 0;    // divides the width
  std::size_t ratio = 0;    // of a layer's inner width to its width
  std::size_t samples = 0;  // of the surface
  std::size_t anchors = 0;  // the first samples, among which attention goes
  std::size_t near = 0;     // samples that an anchor gathers from
  std::size_t globals = 0;  // further tokens, for the whole body
};

// x + attention(norm(x)), then x + contract(rectified(expand(norm(x)))).
struct AttentionLayer {
  LayerNorm attentionNorm, innerNorm;
  Linear queryKeyValue, attended;
  Linear expand, contract;
};

// What both networks have. Samples are embedded each by itself; anchors gather the largest of what is near them, as in
// PointNet++ (Qi et al. 2017); then global tokens, anchors and further tokens attend to each other, layer by layer.
struct NetworkTrunk {
  NetworkSizes sizes;
  Linear embedFirst, embedSecond;
  Linear gatherFeature, gatherOffset, gathered;
  FloatMatrix globalTokens;
  std::vector<AttentionLayer> layers;
  LayerNorm norm;
  Linear whole;  // of all global tokens
};

struct ReadingNetwork {
  NetworkTrunk trunk;
  FloatMatrix roleTokens;  // a row for each role
  Linear pinPosition;
  std::vector<float> pinToken;  // a pin is the sum of these three
  Linear vote, voteOffset;      // by anchor
  Linear has, logError, plan, fingers;
  Linear sampleInner, samplePart, sampleBone;
};

struct StanceNetwork {
  NetworkTrunk trunk;
  Linear score;
};

inline constexpr std::size_t kFirstWidth = 64;   // of a sample's first layer
inline constexpr std::size_t kHands = 2;         // left, right
inline constexpr std::size_t kFingerCounts = 6;  // none to five
inline constexpr std::size_t kBoneNumbers = 6;   // offsets from a sample to the start and the end of its bone
inline constexpr std::size_t kStances = 24;      // the proper rotations of the cube
inline constexpr float kMinLogError = -6, kMaxLogError = 2;

// A joint's position that is known.
struct RolePin {
  Index role = 0;
  Vec3f position = Vec3f::Zero();
};

struct ReadingOutput {
  FloatMatrix positions;        // a row for each role
  std::vector<float> has;       // logit for each role
  std::vector<float> logError;  // for each role: logarithm of the expected distance from the truth
  std::vector<float> plan;      // logits
  FloatMatrix parts;            // a row of logits for each sample
  FloatMatrix bones;            // kBoneNumbers for each sample
  FloatMatrix fingers;          // a row of kFingerCounts logits for each hand
};

// features  of sampleFeatures, a row for each of the network's samples
// pins      roles in range
// Throws Error kBadArgument for another number of rows or a role that there is not.
// Cost: 80 million multiplications, 11 ms on one core, for the sizes that limber comes with.
ReadingOutput evaluate(const ReadingNetwork& network, const FloatMatrix& features, std::span<const RolePin> pins);

// How well a body stands, with up +Y and front +Z: of a body's stances the one that scores most is it. 0.8 ms.
float evaluate(const StanceNetwork& network, const FloatMatrix& features);

}  // namespace limber
