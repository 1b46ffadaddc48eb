// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/mot.hpp"

#include "core/base/mapping.hpp"
#include "core/text/names.hpp"

namespace rg::text {

void appendMot(std::string& out, const objects::Objects& objects, const FrameStamp& stamp) {
  const FrameMap map = mapBetween(objects.size, stamp.size);
  for (const objects::Object& object : objects.objects) {
    if (!objects::isListed(object.state)) continue;
    const Box box = map.box(object.box);
    appendUnsigned(out, stamp.number);
    out += ',';
    appendUnsigned(out, object.id);
    for (const int value : {box.x, box.y, box.width, box.height}) {
      out += ',';
      appendInteger(out, value);
    }
    out += ",1,-1,-1,-1\n";
  }
}

}  // namespace rg::text
