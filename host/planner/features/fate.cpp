#include "host/planner/features/fate.hpp"

namespace pinjaw::planner {

std::string_view to_string(Fate fate) {
  switch (fate) {
    case Fate::Seam:
      return "seam";
    case Fate::Degenerate:
      return "degenerate";
    case Fate::NotGraspable:
      return "not_graspable";
    case Fate::Upright:
      return "upright";
    case Fate::OffSurface:
      return "off_surface";
    case Fate::Hidden:
      return "hidden";
    case Fate::InFlat:
      return "in_flat";
    case Fate::LowStep:
      return "low_step";
    case Fate::Coincident:
      return "coincident";
    case Fate::TooShort:
      return "too_short";
    case Fate::NoRoom:
      return "no_room";
    case Fate::Kept:
      return "kept";
  }
  return "?";
}

std::string_view meaning_of(Fate fate) {
  switch (fate) {
    case Fate::Seam:
      return "seam of a closed face";
    case Fate::Degenerate:
      return "pole or tip, no curve";
    case Fate::NotGraspable:
      return "not graspable, as the profile says";
    case Fate::Upright:
      return "upright, a point in plan";
    case Fate::OffSurface:
      return "beside the part's surface";
    case Fate::Hidden:
      return "hidden, other surface lies below";
    case Fate::InFlat:
      return "the surface runs on across it";
    case Fate::LowStep:
      return "step under the engagement";
    case Fate::Coincident:
      return "above or below another that counts for both";
    case Fate::TooShort:
      return "shorter than eps";
    case Fate::NoRoom:
      return "no room for a closed pin";
    case Fate::Kept:
      return "kept";
  }
  return "?";
}

}  // namespace pinjaw::planner
