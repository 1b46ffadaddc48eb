// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/result_packer.hpp"

#include "core/base/memory/spare.hpp"

namespace rg::objects {

void ResultPacker::endFrame() {
  std::apply([](auto&... shelf) { (shelf.made.clear(), ...); }, shelves_);
}

void ResultPacker::drop() {
  std::apply([](auto&... shelf) { (shelf.drop(), ...); }, shelves_);
}

void ResultPacker::fill(const background::Foreground& from, background::Foreground& to) {
  to.size = from.size;
  to.status = from.status;
  to.picture = nullptr;
  planes_.pack(from.mask, to.mask);
  to.extent = from.extent;
  copyTight(from.areas, to.areas);
  to.interest = from.interest;
  to.scene = from.scene;
}

void ResultPacker::fill(const segmentation::Labels& from, segmentation::Labels& to) {
  to.size = from.size;
  to.status = from.status;
  to.scope = from.scope;
  to.picture = nullptr;
  to.foreground = pack(from.foreground);
  planes_.pack(from.ids, to.ids);
  planes_.pack(from.hue, to.hue);
  to.count = from.count;
}

void ResultPacker::fill(const graph::Graph& from, graph::Graph& to) {
  to.size = from.size;
  to.status = from.status;
  to.labels = pack(from.labels);
  copyTight(from.regions, to.regions);
  copyTight(from.arcs, to.arcs);
  to.runs = {};
}

void ResultPacker::fill(const motion::Motion& from, motion::Motion& to) {
  to.size = from.size;
  to.status = from.status;
  to.graph = pack(from.graph);
  copyTight(from.regions, to.regions);
  to.matchedBlocks = from.matchedBlocks;
  to.stillBlocks = from.stillBlocks;
}

void ResultPacker::fill(const Objects& from, Objects& to) {
  to.copyTables(from);
  to.motion = pack(from.motion);
  planes_.pack(from.slots, to.slots);
}

}  // namespace rg::objects
