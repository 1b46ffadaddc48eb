// SPDX-License-Identifier: LGPL-2.1-or-later
// Cascades as OpenCV writes them.
#pragma once

#include <glib.h>
#include <glib/gstdio.h>

#include <string>
#include <unistd.h>

namespace rg::testing {

/// The cascade of tests/core/detection/cascades.hpp: the left half is brighter than the right one.
inline constexpr const char* kHalvesXml = R"(<?xml version="1.0"?>
<!-- Halves. -->
<opencv_storage>
<cascade type_id="opencv-cascade-classifier"><stageType>BOOST</stageType>
  <featureType>HAAR</featureType>
  <height>10</height>
  <width>8</width>
  <stageParams><maxWeakCount>1</maxWeakCount></stageParams>
  <featureParams><maxCatCount>0</maxCatCount></featureParams>
  <stageNum>2</stageNum>
  <stages>
    <_><maxWeakCount>1</maxWeakCount>
      <stageThreshold>1.0000000000000001e-05</stageThreshold>
      <weakClassifiers>
        <_><internalNodes> 0 -1 0 1.0000000000000000e-01</internalNodes>
          <leafValues> -1. 1.</leafValues></_></weakClassifiers></_>
    <_><maxWeakCount>1</maxWeakCount>
      <stageThreshold>1e-5</stageThreshold>
      <weakClassifiers>
        <_><internalNodes>0 -1 0 .5</internalNodes>
          <leafValues>-1 1</leafValues></_></weakClassifiers></_></stages>
  <features>
    <_><rects>
        <_>0 0 8 10 -1.</_>
        <_>0 0 4 10 2.</_></rects>
      <tilted>0</tilted></_></features></cascade>
</opencv_storage>
)";

/// A file for as long as it lives.
class CascadeFile {
 public:
  explicit CascadeFile(const std::string& contents = kHalvesXml) {
    g_file_set_contents(path_.c_str(), contents.data(), static_cast<gssize>(contents.size()),
                        nullptr);
  }
  ~CascadeFile() { g_unlink(path_.c_str()); }
  CascadeFile(const CascadeFile&) = delete;
  CascadeFile& operator=(const CascadeFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_ = std::string(g_get_tmp_dir()) + "/haarcascade_halves-" +
                      std::to_string(getpid()) + '-' + std::to_string(g_get_monotonic_time()) +
                      ".xml";
};

}  // namespace rg::testing
