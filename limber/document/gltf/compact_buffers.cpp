#include "limber/document/gltf/compact_buffers.h"

#include <algorithm>
#include <vector>

#include "limber/document/gltf/accessor_layout.h"
#include "limber/document/gltf/references.h"
#include "limber/document/uri.h"

namespace limber {

namespace {

struct Range {
  std::size_t begin, end;
  std::size_t newBegin = 0;
};

using Ranges = std::vector<Range>;

void sortAndMerge(Ranges& ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
  Ranges merged;
  for (const Range& range : ranges) {
    if (!merged.empty() && range.begin <= merged.back().end) {
      merged.back().end = std::max(merged.back().end, range.end);
    } else {
      merged.push_back(range);
    }
  }
  ranges = std::move(merged);
}

// For each buffer what views cover of it, widened to multiples of four, in rising order without overlap.
std::vector<Ranges> coveredRanges(const Asset& asset) {
  std::vector<Ranges> covered(asset.buffers.size());
  for (Index i = 0; i < asset.document.bufferViews.size(); ++i) {
    const ViewLayout view = viewLayout(asset, i);
    const Index buffer = asset.document.bufferViews[i].buffer;
    const std::size_t end = std::min((view.offset + view.bytes.size() + 3) / 4 * 4, asset.buffers[buffer].bytes.size());
    if (!view.bytes.empty()) covered[buffer].push_back({view.offset / 4 * 4, end});
  }
  for (Ranges& ranges : covered) sortAndMerge(ranges);
  return covered;
}

std::size_t newOffset(const Ranges& ranges, std::size_t offset) {
  const auto behind = std::upper_bound(ranges.begin(), ranges.end(), offset,
                                       [](std::size_t value, const Range& range) { return value < range.begin; });
  if (behind == ranges.begin()) return 0;  // an empty view before all others
  const Range& range = *std::prev(behind);
  return range.newBegin + std::min(offset, range.end) - range.begin;
}

// Keeps only these ranges of a buffer's bytes and says so in them; false if that is all of it.
bool cutBuffer(Asset& asset, Index buffer, Ranges& ranges) {
  Bytes& old = asset.buffers[buffer].bytes;
  Bytes kept;
  for (Range& range : ranges) {
    range.newBegin = kept.size();
    kept.insert(kept.end(), old.begin() + static_cast<std::ptrdiff_t>(range.begin),
                old.begin() + static_cast<std::ptrdiff_t>(range.end));
  }
  if (kept.size() == old.size()) return false;
  old = std::move(kept);
  asset.document.buffers[buffer].byteLength = old.size();
  std::string& uri = asset.buffers[buffer].uri;
  if (!isDataUri(uri)) {
    uri.clear();
    asset.document.buffers[buffer].uri.clear();
  }
  return true;
}

std::vector<bool> usedViews(const gltf::Document& document) {
  std::vector<bool> used(document.bufferViews.size(), false);
  visitReferences(document, [&](ElementKind kind, Index number) {
    if (kind == ElementKind::kBufferView && number < used.size()) used[number] = true;
  });
  return used;
}

}  // namespace

BufferViewSweep::BufferViewSweep(const Asset& asset) : usedBefore_(usedViews(asset.document)) {}

void BufferViewSweep::sweep(Asset& asset) const {
  gltf::Document& document = asset.document;
  const std::vector<bool> used = usedViews(document);
  std::vector<Index> number(used.size());
  std::vector<gltf::BufferView> kept;
  std::set<Index> buffers;
  for (Index view = 0; view < used.size(); ++view) {
    if (!used[view] && view < usedBefore_.size() && usedBefore_[view]) {
      buffers.insert(document.bufferViews[view].buffer);
    } else {
      number[view] = addElement(kept, std::move(document.bufferViews[view]));
    }
  }
  document.bufferViews = std::move(kept);
  changeReferences(document, [&](ElementKind kind, Index& view) {
    if (kind == ElementKind::kBufferView && view < number.size()) view = number[view];
  });
  dropUnusedBytes(asset, buffers);
}

void dropUnusedBytes(Asset& asset, const std::set<Index>& buffers) {
  std::vector<Ranges> covered = coveredRanges(asset);
  std::vector<bool> changed(covered.size(), false);
  for (const Index buffer : buffers) changed[buffer] = cutBuffer(asset, buffer, covered[buffer]);
  for (gltf::BufferView& view : asset.document.bufferViews) {
    if (changed[view.buffer]) view.byteOffset = newOffset(covered[view.buffer], view.byteOffset);
  }
}

void removeEmptyBuffers(Asset& asset) {
  gltf::Document& document = asset.document;
  std::vector<bool> named(asset.buffers.size(), false);
  for (const gltf::BufferView& view : document.bufferViews) named[view.buffer] = true;

  std::vector<Index> newIndex;
  std::vector<Asset::Buffer> kept;
  std::vector<gltf::Buffer> keptBuffers;
  for (std::size_t i = 0; i < asset.buffers.size(); ++i) {
    newIndex.push_back(static_cast<Index>(kept.size()));
    if (!named[i] && asset.buffers[i].bytes.empty()) continue;
    kept.push_back(std::move(asset.buffers[i]));
    keptBuffers.push_back(std::move(document.buffers[i]));
  }
  asset.buffers = std::move(kept);
  document.buffers = std::move(keptBuffers);
  changeReferences(document, [&](ElementKind kind, Index& number) {
    if (kind == ElementKind::kBuffer && number < newIndex.size()) number = newIndex[number];
  });
}

}  // namespace limber
