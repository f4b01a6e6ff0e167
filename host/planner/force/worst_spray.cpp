#include "host/planner/force/worst_spray.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "host/planner/force/source_loads.hpp"
#include "host/planner/force/squeeze.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFlat = 1e-7;   // rad: normals this close are one face's rounding
constexpr double kSmooth = 0.5;  // least cosine of a node's normal to its triangle's; others are not trusted
constexpr double kInset =
    1e-4;  // share of a triangle's size by which corners are moved in before a ray is traced
constexpr double kSmallest_mm = 1e-3;  // triangles under it are not split

using Corners = std::array<Vector3d, 3>;

/// A triangle of the surface, or a part of one, with the smooth surface's normals at its corners.
struct Piece {
  Corners p_mm;
  Corners normal;
  double upper_n = kInfinity;  ///< no jet on it needs more
  std::size_t jet = 0;
  int triangle = 0;
  int number = 0;  ///< order of making, so that equal bounds are taken in one order
};

struct LowerBound {
  bool operator()(const Piece& a, const Piece& b) const {
    return a.upper_n != b.upper_n ? a.upper_n < b.upper_n : a.number > b.number;
  }
};

Vector3d normal_of(const Corners& p_mm) {
  return (p_mm[1] - p_mm[0]).cross(p_mm[2] - p_mm[0]).normalized();
}

double size_mm(const Corners& p_mm) {
  return std::max({(p_mm[1] - p_mm[0]).norm(), (p_mm[2] - p_mm[1]).norm(), (p_mm[0] - p_mm[2]).norm()});
}

Corners corners_of(const geometry::TriangleMesh& mesh, std::size_t triangle) {
  Corners p_mm;
  for (std::size_t k = 0; k < 3; ++k)
    p_mm[k] = mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle][k])];
  return p_mm;
}

/// The smooth surface's normals at a triangle's corners, or the facet's where they are not known.
Corners normals_of(const geometry::TriangleMesh& mesh, std::size_t triangle, const Vector3d& facet) {
  Corners normals{facet, facet, facet};
  for (std::size_t k = 0; k < 3 && !mesh.normals.empty(); ++k) {
    const Vector3d& known = mesh.normals[static_cast<std::size_t>(mesh.triangles[triangle][k])];
    if (known.dot(facet) > kSmooth) normals[k] = known;
  }
  return normals;
}

/// Largest angle of the smooth surface's normals to the facet's; 0 on a flat face.
double spread_rad(const Corners& normals, const Vector3d& facet) {
  double spread = 0;
  for (const Vector3d& normal : normals)
    spread = std::max(spread, std::atan2(normal.cross(facet).norm(), normal.dot(facet)));
  return spread < kFlat ? 0 : spread;
}

bool has_curved_faces(const geometry::TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vector3d facet = normal_of(corners_of(mesh, i));
    if (facet.norm() > 0.5 && spread_rad(normals_of(mesh, i, facet), facet) > 0) return true;
  }
  return false;
}

using Samples = std::vector<std::vector<SprayHit>>;

/// One grasp under the jets of one part.
class Search {
 public:
  Search(const SprayedPart& part, const std::vector<Jet>& jets, std::vector<JetReach>& reach,
         const Samples& samples, const WorstOptions& options, const Grasp& grasp, model::Side side,
         model::FrictionModel friction)
      : part_(part),
        jets_(jets),
        reach_(reach),
        samples_(samples),
        options_(options),
        solver_(grasp),
        side_(side),
        friction_(friction) {
    rim_n_ = rim_need_n();
  }

  std::optional<model::Certified> run() {
    try_samples();
    fill();
    for (int splits = 0; !pieces_.empty();) {
      const Piece piece = pieces_.top();
      if (settled(piece.upper_n) || splits >= options_.most_splits) {
        high_n_ = std::max(high_n_, piece.upper_n);
        look_at_the_rest();
        break;
      }
      pieces_.pop();
      visit(piece);
      if (settled(piece.upper_n) || size_mm(piece.p_mm) < kSmallest_mm) {
        high_n_ = std::max(high_n_, piece.upper_n);
        continue;
      }
      split(piece);
      ++splits;
    }
    if (!found_) return std::nullopt;
    found_->high_n = std::max(high_n_, found_->low_n);
    found_->closed = settled(found_->high_n);
    found_->sampled_n = sampled_n_;
    return found_;
  }

 private:
  double needed_n(const model::Wrench& wrench) {
    const auto outcome = solver_.least_squeeze(turned(wrench, side_), friction_);
    if (const auto* required = std::get_if<Required>(&outcome)) return required->force_n;
    return kInfinity;
  }

  /// The true surface lies within the chord error of its triangles, sideways too where a curved edge bounds a
  /// flat face: that moves a jet's torque, and F_sq(a + b) <= F_sq(a) + F_sq(b). A part of flat faces alone
  /// has no such error.
  double rim_need_n() {
    if (part_.chord_error_mm == 0 || !has_curved_faces(part_.surface->mesh())) return 0;
    Vector3d per_nmm;
    for (int axis = 0; axis < 3; ++axis) {
      model::Wrench twist = model::Wrench::Zero();
      twist[3 + axis] = 1;
      per_nmm[axis] = std::max(needed_n(twist), needed_n(-twist));
    }
    double strongest_n = 0;
    for (const Jet& jet : jets_) strongest_n = std::max(strongest_n, jet.spray.force_n);
    return per_nmm.norm() * strongest_n * part_.chord_error_mm;
  }

  [[nodiscard]] bool settled(double upper_n) const {
    if (!found_) return false;
    if (std::isinf(found_->low_n)) return true;
    return upper_n - rim_n_ <=
           found_->low_n + std::max(options_.tolerance_n, options_.tolerance_share * found_->low_n);
  }

  /// The worst sample is the first spray to beat. It pushes along its facet's normal.
  void try_samples() {
    for (std::size_t jet = 0; jet < jets_.size(); ++jet) {
      for (const SprayHit& hit : samples_[jet]) {
        const Vector3d normal = -hit.force_n.normalized();
        const JetNeed needed = need(jets_[jet], hit.p_mm, normal);
        sampled_n_ = std::max(sampled_n_, needed.force_n);
        if (!beats(needed)) continue;
        const Corners p_mm = corners_of(part_.surface->mesh(), static_cast<std::size_t>(hit.triangle));
        const Corners normals =
            normals_of(part_.surface->mesh(), static_cast<std::size_t>(hit.triangle), normal_of(p_mm));
        take(jet, needed, {hit.p_mm, normal, hit.from}, spread_rad(normals, normal_of(p_mm)) > 0);
      }
    }
  }

  /// Where hidden places use up the splits, the worst spray may wait behind them: the low end still gains.
  void look_at_the_rest() {
    for (int looks = 0; looks < options_.most_looks && !pieces_.empty(); ++looks) {
      if (settled(pieces_.top().upper_n)) return;
      visit(pieces_.top());
      pieces_.pop();
    }
  }

  void fill() {
    const geometry::TriangleMesh& mesh = part_.surface->mesh();
    for (std::size_t jet = 0; jet < jets_.size(); ++jet) {
      alone_n_.push_back(0);
      for (const model::Disturbance& with : jets_[jet].with)
        alone_n_.back() = std::max(alone_n_.back(), needed_n(with.wrench));
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        Piece piece;
        piece.jet = jet;
        piece.triangle = static_cast<int>(i);
        piece.p_mm = corners_of(mesh, i);
        const Vector3d facet = normal_of(piece.p_mm);
        if (!(facet.norm() > 0.5) || reach_[jet].faces_away(piece.triangle))
          continue;  // no area: no jet hits it
        piece.normal = normals_of(mesh, i, facet);
        push(piece);
      }
    }
  }

  /// Bounds what a jet on the piece needs, and queues it unless that is less than what was found.
  void push(Piece piece) {
    piece.upper_n = std::min(piece.upper_n, bound_n(piece));
    piece.number = made_++;
    if (settled(piece.upper_n)) {
      high_n_ = std::max(high_n_, piece.upper_n);
    } else {
      pieces_.push(piece);
    }
  }

  double bound_n(const Piece& piece) {
    const Jet& jet = jets_[piece.jet];
    const Vector3d facet = normal_of(piece.p_mm);
    const double spread = spread_rad(piece.normal, facet);
    double bound = 0;
    if (spread == 0) {
      for (const Vector3d& p_mm : piece.p_mm) bound = std::max(bound, need(jet, p_mm, facet).force_n);
      return bound + rim_n_;
    }
    // every unit normal between n1..n3 and the facet's is a mean of theirs, times at most 1 / cos spread
    const double outer = 1 / std::cos(spread);
    for (const Vector3d& p_mm : piece.p_mm) {
      bound = std::max(bound, need(jet, p_mm, outer * facet).force_n);
      for (const Vector3d& normal : piece.normal)
        bound = std::max(bound, need(jet, p_mm, outer * normal).force_n);
    }
    return std::max(bound, alone_n_[piece.jet]) + rim_n_;
  }

  JetNeed need(const Jet& jet, const Vector3d& p_mm, const Vector3d& normal) {
    return jet_need(solver_, jet, p_mm, normal, side_, friction_);
  }

  /// Tries the piece's corners, the worst first, as the spray to beat.
  void visit(const Piece& piece) {
    const Vector3d middle_mm = (piece.p_mm[0] + piece.p_mm[1] + piece.p_mm[2]) / 3;
    const Vector3d middle = (piece.normal[0] + piece.normal[1] + piece.normal[2]) / 3;
    struct Try {
      Vector3d p_mm;
      Vector3d normal;
      JetNeed need;
    };
    std::vector<Try> tries;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d p_mm = piece.p_mm[k] + kInset * (middle_mm - piece.p_mm[k]);
      const Vector3d normal = (piece.normal[k] + kInset * (middle - piece.normal[k])).normalized();
      tries.push_back({p_mm, normal, need(jets_[piece.jet], p_mm, normal)});
    }
    std::stable_sort(tries.begin(), tries.end(),
                     [](const Try& a, const Try& b) { return a.need.force_n > b.need.force_n; });
    for (const Try& one : tries) {
      if (!beats(one.need)) return;
      const auto from = reach_[piece.jet].direction_to(one.p_mm, piece.triangle);
      if (!from) continue;
      take(piece.jet, one.need, {one.p_mm, one.normal, *from},
           spread_rad(piece.normal, normal_of(piece.p_mm)) > 0);
    }
  }

  /// Where a spray hits, the outward normal there, and where it comes from.
  struct Strike {
    Vector3d at_mm;
    Vector3d normal;
    Vector3d from;
  };

  [[nodiscard]] bool beats(const JetNeed& needed) const { return !found_ || needed.force_n > found_->low_n; }

  void take(std::size_t which, const JetNeed& needed, const Strike& strike, bool curved) {
    const Jet& jet = jets_[which];
    const std::string& with = jet.with[needed.with].name;
    found_ = model::Certified{.low_n = needed.force_n,
                              .spray = with.empty() ? jet.name : jet.name + " with " + with,
                              .at_mm = strike.at_mm,
                              .normal = strike.normal,
                              .from = strike.from,
                              .curved = curved};
  }

  void split(const Piece& piece) {
    Corners middle_mm;
    Corners middle;
    for (std::size_t k = 0; k < 3; ++k) {
      middle_mm[k] = (piece.p_mm[k] + piece.p_mm[(k + 1) % 3]) / 2;
      middle[k] = (piece.normal[k] + piece.normal[(k + 1) % 3]).normalized();
    }
    for (std::size_t k = 0; k < 3; ++k) {
      Piece corner = piece;
      corner.p_mm = {piece.p_mm[k], middle_mm[k], middle_mm[(k + 2) % 3]};
      corner.normal = {piece.normal[k], middle[k], middle[(k + 2) % 3]};
      push(corner);
    }
    Piece inner = piece;
    inner.p_mm = middle_mm;
    inner.normal = middle;
    push(inner);
  }

  SprayedPart part_;
  const std::vector<Jet>& jets_;
  std::vector<JetReach>& reach_;
  const Samples& samples_;
  WorstOptions options_;
  SqueezeSolver solver_;
  model::Side side_;
  model::FrictionModel friction_;
  double rim_n_ = 0;             ///< what the triangles' chord error can add
  std::vector<double> alone_n_;  ///< what acts with each jet, without it
  std::priority_queue<Piece, std::vector<Piece>, LowerBound> pieces_;
  int made_ = 0;
  double sampled_n_ = 0;  ///< over the samples
  double high_n_ = 0;     ///< over the pieces that are done with
  std::optional<model::Certified> found_;
};

}  // namespace

JetNeed jet_need(SqueezeSolver& solver, const Jet& jet, const Vector3d& p_mm, const Vector3d& normal,
                 model::Side side, model::FrictionModel friction) {
  JetNeed worst{-1, 0};
  const model::Wrench push = force_at(p_mm, -jet.spray.force_n * normal);
  for (std::size_t i = 0; i < jet.with.size(); ++i) {
    const auto outcome = solver.least_squeeze(turned(jet.with[i].wrench + push, side), friction);
    const auto* required = std::get_if<Required>(&outcome);
    const double force_n = required == nullptr ? kInfinity : required->force_n;
    if (force_n > worst.force_n) worst = {force_n, i};
  }
  return worst;
}

WorstSpray::WorstSpray(const SprayedPart& part, std::vector<Jet> jets, const WorstOptions& options)
    : part_(part), options_(options), jets_(std::move(jets)) {
  for (const Jet& jet : jets_) {
    reach_.emplace_back(*part_.surface, jet.spray);
    auto& samples = samples_.emplace_back();
    const auto hits = spray_hits(jet.spray, *part_.surface);
    if (!hits) continue;  // rays that do not find the part are no sample, and sampled_n tells that
    for (const SprayHit& hit : *hits) {
      if (jet_meets_first(*part_.surface, hit.p_mm, hit.from)) samples.push_back(hit);
    }
  }
}

std::optional<model::Certified> WorstSpray::of(const Grasp& grasp, model::Side side,
                                               model::FrictionModel friction) {
  return Search(part_, jets_, reach_, samples_, options_, grasp, side, friction).run();
}

}  // namespace pinjaw::planner
