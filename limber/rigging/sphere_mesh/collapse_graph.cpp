#include "limber/rigging/sphere_mesh/collapse_graph.h"

#include <algorithm>
#include <bit>

#include "limber/rigging/sphere_mesh/monotone_queue.h"

namespace limber {

CollapseGraph::CollapseGraph(std::span<const GraphEdge> edges, std::span<const Border> borders,
                             std::vector<std::uint8_t> single)
    : single_(std::move(single)), blocks_(single_.size()) {
  edges_.reserve(edges.size());
  for (const GraphEdge& e : edges) {
    edges_.push_back({e, borders.empty() ? 0 : borders[edges_.size()], 0});
    ++blocks_[e.from].size;
    if (nodeOf(e.to) != e.from) ++blocks_[nodeOf(e.to)].size;
  }
  std::size_t begin = 0;
  for (Block& block : blocks_) {
    const Index needed = std::max(block.size, Index{1});
    block.sizeClass = static_cast<std::uint8_t>(std::bit_width((needed - 1) / capacity(0)));
    block.begin = begin;
    block.size = 0;
    begin += capacity(block.sizeClass);
  }
  pool_.reserve(begin + begin / 2);
  pool_.resize(begin);
  for (Index e = 0; e < edges_.size(); ++e) {
    const Index from = edges_[e].from;
    const EdgeEnd to = edges_[e].to;
    links(from)[blocks_[from].size++] = {to, e};
    const Index other = nodeOf(to);
    if (other != from) links(other)[blocks_[other].size++] = {makeEnd(from, crossesOf(to)), e};
  }
  marks_.resize(2 * blocks_.size());
}

void CollapseGraph::merge(Index e, Index kept, const MonotoneQueue& keys) {
  const Edge ends = edges_[e];
  operation_.edge = e;
  operation_.kept = kept;
  operation_.gone = ends.from == kept ? nodeOf(ends.to) : ends.from;
  operation_.crosses = crossesOf(ends.to);
  operation_.toSingle = operation_.gone == kept || single(kept) || single(operation_.gone);
  operation_.turnsSingle = operation_.toSingle && !single(kept);
  keys_ = &keys;
  dead_.clear();
  touched_.clear();
  kill(e);
  if (lazy(kept) && !operation_.turnsSingle) {
    mergeIntoHub();
  } else {
    mergeByMarks();
  }
  single_[kept] = operation_.toSingle;
}

void CollapseGraph::kill(Index e, Index joined) {
  edges_[e].from = kNoIndex;
  dead_.push_back({e, joined, edges_[e].border});
  if (joined != kNoIndex) edges_[joined].border += edges_[e].border;
}

EdgeEnd CollapseGraph::retarget(EdgeEnd to, bool fromGone) const {
  const Index node = nodeOf(to);
  if (inside(node)) return makeEnd(operation_.kept, true);
  if (operation_.toSingle || single(node)) return makeEnd(node, false);
  return fromGone && operation_.crosses ? to ^ 1 : to;
}

// Reads both neighbourhoods whole. Which links to a neighbour have been met is looked up in the short list of them, or
// by marks where it may be long.
void CollapseGraph::mergeByMarks() {
  const Index kept = operation_.kept, gone = operation_.gone;
  constexpr Index kShort = 40;
  marking_ = blocks_[kept].size + blocks_[gone].size > kShort;
  if (marking_) ++time_;
  merged_.clear();
  gather(kept);
  if (gone != kept) gather(gone);

  const Index size = static_cast<Index>(merged_.size());
  if (capacity(blocks_[kept].sizeClass) < size && gone != kept) std::swap(blocks_[kept], blocks_[gone]);
  if (capacity(blocks_[kept].sizeClass) < size) {
    release(blocks_[kept]);
    blocks_[kept] = allocate(size);
  }
  if (gone != kept) release(blocks_[gone]);
  blocks_[kept].size = size;
  std::copy(merged_.begin(), merged_.end(), links(kept));
}

// The edge kept so far that leads to `to`, if any.
Index* CollapseGraph::find(EdgeEnd to) {
  if (marking_) {
    const Mark mark = marks_[to];
    return mark.time == time_ ? &merged_[mark.slot].edge : nullptr;
  }
  for (Link& link : merged_) {
    if (link.to == to) return &link.edge;
  }
  return nullptr;
}

void CollapseGraph::keep(Link link) {
  if (marking_) marks_[link.to] = {time_, static_cast<Index>(merged_.size())};
  merged_.push_back(link);
}

void CollapseGraph::gather(Index source) {
  const bool fromGone = source != operation_.kept;
  const Index kept = operation_.kept;
  const bool lazySource = lazy(source);
  const Link* const begin = links(source);
  for (const Link* link = begin; link != begin + blocks_[source].size; ++link) {
    const Index e = link->edge;
    if (lazySource ? !alive(e) : e == operation_.edge) continue;
    const EdgeEnd to = lazySource ? otherEnd(e, source) : link->to;
    const Index node = nodeOf(to);
    const bool isInside = inside(node);
    if (isInside) {
      if (node != source && !fromGone) continue;  // the opposite direction between kept and gone: met again from gone
      if (operation_.toSingle) {
        kill(e);
        continue;
      }
    }
    const EdgeEnd target = retarget(to, fromGone);
    if (Index* const holder = find(target)) {
      const Index loser = keys_->key(*holder) >= keys_->key(e) ? e : *holder;
      kill(loser, loser == e ? *holder : e);
      if (!isInside) unlink(node, loser);
      if (loser == e) continue;
      *holder = e;
    } else {
      keep({target, e});
    }
    if (!fromGone && target == to) continue;  // nothing new about it
    edges_[e].from = kept;
    edges_[e].to = target;
    if (!isInside) relink(node, e, makeEnd(kept, crossesOf(target)));
    if (fromGone || operation_.turnsSingle) touched_.push_back(e);
  }
}

// A node with many links takes in one with few: only the latter's links are read.
void CollapseGraph::mergeIntoHub() {
  const Index gone = operation_.gone;
  const Index kept = operation_.kept;
  if (gone == kept) return;  // a single node has no edge to itself
  const bool lazyGone = lazy(gone);
  const Block block = blocks_[gone];
  for (Index i = 0; i < block.size; ++i) {
    const Link link = pool_[block.begin + i];
    if (!alive(link.edge)) continue;
    joinHub(link.edge, lazyGone ? otherEnd(link.edge, gone) : link.to);
  }
  release(block);
  blocks_[gone] = Block{};
  if (!lazy(kept)) compact(kept);  // no hub any more: its links are kept up to date from now on
}

void CollapseGraph::joinHub(Index e, EdgeEnd to) {
  const Index kept = operation_.kept, node = nodeOf(to);
  const bool isInside = inside(node);
  if (isInside && operation_.toSingle) {
    kill(e);
    return;
  }
  const EdgeEnd target = retarget(to, true);
  const Index twin = findEdge(kept, target);
  if (twin != kNoIndex && twin != e) {
    const Index loser = keys_->key(twin) >= keys_->key(e) ? e : twin;
    kill(loser, loser == e ? twin : e);
    if (!isInside) unlink(node, loser);
    if (loser == e) return;
  }
  edges_[e].from = kept;
  edges_[e].to = target;
  if (!isInside) relink(node, e, makeEnd(kept, crossesOf(target)));
  if (node != kept) append(kept, {target, e});  // a second edge between kept and gone is there already
  touched_.push_back(e);
}

// The living edge from `a` to `to`, looked for in the shorter of the two neighbourhoods.
Index CollapseGraph::findEdge(Index a, EdgeEnd to) {
  Index reader = a, other = nodeOf(to);
  if (blocks_[other].size < blocks_[reader].size) std::swap(reader, other);
  const EdgeEnd sought = makeEnd(other, crossesOf(to));
  const Link* const begin = links(reader);
  for (const Link* link = begin; link != begin + blocks_[reader].size; ++link) {
    if (alive(link->edge) && link->edge != operation_.edge && otherEnd(link->edge, reader) == sought) return link->edge;
  }
  return kNoIndex;
}

CollapseGraph::Block CollapseGraph::allocate(Index size) {
  Block block;
  block.sizeClass = static_cast<std::uint8_t>(std::bit_width((std::max(size, Index{1}) - 1) / capacity(0)));
  std::vector<std::size_t>& free = free_[block.sizeClass];
  if (free.empty()) {
    block.begin = pool_.size();
    pool_.resize(pool_.size() + capacity(block.sizeClass));
  } else {
    block.begin = free.back();
    free.pop_back();
  }
  return block;
}

void CollapseGraph::append(Index node, Link link) {
  if (blocks_[node].size == capacity(blocks_[node].sizeClass)) {
    compact(node);
    const Block old = blocks_[node];
    if (4 * std::size_t{old.size} > 3 * std::size_t{capacity(old.sizeClass)}) {
      Block grown = allocate(capacity(old.sizeClass) + 1);
      grown.size = old.size;
      std::copy_n(pool_.data() + old.begin, old.size, pool_.data() + grown.begin);
      release(old);
      blocks_[node] = grown;
    }
  }
  links(node)[blocks_[node].size++] = link;
}

void CollapseGraph::compact(Index node) {
  Link* const begin = links(node);
  Link* out = begin;
  for (const Link* link = begin; link != begin + blocks_[node].size; ++link) {
    if (alive(link->edge)) *out++ = {otherEnd(link->edge, node), link->edge};
  }
  blocks_[node].size = static_cast<Index>(out - begin);
}

void CollapseGraph::relink(Index node, Index e, EdgeEnd to) {
  if (lazy(node)) return;
  Link* link = links(node);
  while (link->edge != e) ++link;
  link->to = to;
}

void CollapseGraph::unlink(Index node, Index e) {
  if (lazy(node)) return;
  Link* const begin = links(node);
  Link* link = begin;
  while (link->edge != e) ++link;
  *link = begin[--blocks_[node].size];
}

}  // namespace limber
