// A crowd's file across the C boundary, for a page to draw. limber.mjs is the typed face of this function.
#include <algorithm>
#include <map>
#include <string>

#include "call_result.h"
#include "limber/crowd/crowd_frames.h"
#include "limber/document/read.h"
#include "limber/session/rigged_model.h"
#include "surface_bytes.h"

namespace {

using limber::Json;
using limber::wasm::CallResult;
using limber::wasm::guarded;

// Behind what is there, from a multiple of 4 bytes on.
Json placed(limber::Bytes& bytes, const limber::Bytes& more) {
  bytes.resize((bytes.size() + 3) / 4 * 4);
  Json entry = {{"offset", bytes.size()}, {"size", more.size()}};
  bytes.insert(bytes.end(), more.begin(), more.end());
  return entry;
}

CallResult crowdOf(const limber::Asset& asset) {
  const std::vector<limber::CrowdMember> members = limber::crowdMembers(asset);
  const limber::CrowdAnimation animation = limber::readCrowdAnimation(asset, members);
  CallResult result{true, {}, {}};
  Json tables = Json::array(), builds = Json::array(), bodies = Json::array();
  for (const limber::CrowdFrames& table : animation.tables) {
    tables.push_back({{"frames", table.frames},
                      {"joints", table.joints},
                      {"matrices", placed(result.bytes, limber::wasm::bytesOf(table.matrices))}});
  }
  std::map<limber::Index, std::size_t> buildOf;
  for (const limber::CrowdMember& member : members) {
    const auto [build, isNew] = buildOf.try_emplace(member.build, builds.size());
    if (isNew) {
      const CallResult surface =
          limber::wasm::surfaceOf(*limber::readRiggedModel(limber::crowdMemberAlone(asset, member)));
      builds.push_back({{"bytes", placed(result.bytes, surface.bytes)}, {"account", Json::parse(surface.account)}});
    }
    const auto table = std::find_if(
        animation.tables.begin(), animation.tables.end(),
        [&](const limber::CrowdFrames& one) { return one.build == member.build && one.clip == member.clip; });
    Json entry = Json::array();
    for (int i = 0; i < 16; ++i) entry.push_back(member.transform.matrix().data()[i]);
    bodies.push_back({{"build", build->second},
                      {"table", table - animation.tables.begin()},
                      {"row", member.offset - table->first},
                      {"place", std::move(entry)}});
  }
  result.account = limber::dumpReport({{"frames", animation.frames},
                                       {"seconds", animation.seconds},
                                       {"tables", std::move(tables)},
                                       {"builds", std::move(builds)},
                                       {"bodies", std::move(bodies)}},
                                      -1);
  return result;
}

}  // namespace

// A file that `limber crowd` wrote; of any other no bodies.
LIMBER_EXPORT CallResult* limber_crowd(const std::uint8_t* file, std::size_t fileSize, const char* name,
                                       std::size_t nameSize) {
  return guarded({name, nameSize}, [&] { return crowdOf(limber::readAsset({file, fileSize}, {name, nameSize})); });
}
