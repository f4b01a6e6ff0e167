#include "host/part/part.hpp"
#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {
namespace {

/// A part, or a sentence that begins with the file's name.
void answer(std::string_view bytes, const std::string& ending) {
  model::PartSource source;
  source.file = written(bytes, ending);
  const auto part = part::read_part(source);
  if (!part) {
    return must(part.error().message.starts_with(source.file.string() + ":"),
                "a reason without the file: " + part.error().message);
  }
  must(part->volume_mm3 >= 0 && part->centroid_mm.allFinite(), "a part without a place");
  must(!part->surface.mesh().triangles.empty(), "a part without a surface");
}

}  // namespace

std::vector<Target> part_targets() {
  const auto reads = [](const std::string& ending) {
    return [ending](std::string_view bytes) { answer(bytes, ending); };
  };
  return {{"step", reads(".step"), {"configs/parts/l_bracket.step"}, "step.dict"},
          {"stl", reads(".stl"), {"configs/parts/l_bracket.stl"}, "stl.dict"}};
}

}  // namespace pinjaw::fuzz
