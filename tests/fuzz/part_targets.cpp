#include "host/part/part.hpp"
#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {
namespace {

/// A part, or a sentence that begins with the file's name.
void answer_step(std::string_view bytes) {
  model::PartSource source;
  source.file = written(bytes, ".step");
  const auto part = part::read_part(source);
  if (!part) {
    return must(part.error().message.starts_with(source.file.string() + ": "),
                "a reason without the file: " + part.error().message);
  }
  must(part->volume_mm3 > 0 && part->centroid_mm.allFinite(), "a part without a volume");
  must(!part->surface.mesh().triangles.empty(), "a part without a surface");
}

}  // namespace

std::vector<Target> part_targets() {
  return {{"step", answer_step, {"configs/parts/l_bracket.step"}, "step.dict"}};
}

}  // namespace pinjaw::fuzz
