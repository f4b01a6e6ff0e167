#include "host/part/exact.hpp"

#include <Standard_Failure.hxx>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "host/base/files.hpp"
#include "host/part/brep_distance.hpp"
#include "host/part/cad_process.hpp"
#include "host/part/selected.hpp"

namespace pinjaw::part {
namespace {

base::Expected<std::unique_ptr<ExactFaces>> read_faces(const ExactBody& body) {
  const std::string file = body.source.file.string();
  if (!has_brep(body.source)) return base::failure(file + ": a mesh has no exact faces");
  const auto bytes = base::read_file(body.source.file, kMostFileBytes);
  if (!bytes) return base::failure(file + ": " + bytes.error().message);
  const auto solids = chosen_solids(body.source, *bytes, body.selection);
  if (!solids) return tl::unexpected(solids.error());
  return std::make_unique<ExactFaces>(compound_of(solids->chosen),
                                      body.X_QB * Eigen::Isometry3d(upright_rotation(body.source.up)));
}

double answer(const ExactFaces& faces, const ExactQuestion& question) {
  if (const auto* distance = std::get_if<ExactDistance>(&question))
    return faces.distance_mm(distance->column);
  const auto& height = std::get<ExactHeight>(question);
  return faces.height_mm(height.column, height.end, height.guess_mm);
}

std::size_t body_of(const ExactQuestion& question) {
  return std::visit([](const auto& asked) { return asked.body; }, question);
}

/// The answers in the order of the questions, then the tolerances in the order of the bodies.
base::Expected<std::vector<double>> answers(const std::vector<ExactBody>& bodies,
                                            const std::vector<ExactQuestion>& questions,
                                            const base::IsolatedStage& stage) {
  std::vector<double> mm(questions.size() + bodies.size());
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    if (std::ranges::none_of(questions, [&](const auto& asked) { return body_of(asked) == body; })) continue;
    const std::string file = bodies[body].source.file.string();
    try {
      stage("reading the solids of " + file);
      const auto faces = read_faces(bodies[body]);
      if (!faces) return tl::unexpected(faces.error());
      stage("measuring distances to " + file);
      for (std::size_t i = 0; i < questions.size(); ++i) {
        if (body_of(questions[i]) == body) mm[i] = answer(**faces, questions[i]);
      }
      mm[questions.size() + body] = (*faces)->tolerance_mm();
    } catch (const Standard_Failure& reason) {
      return base::failure(file + ": OpenCASCADE cannot measure it: " + reason.GetMessageString());
    }
  }
  return mm;
}

std::string bytes_of(const std::vector<double>& numbers) {
  std::string bytes(numbers.size() * sizeof(double), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

}  // namespace

base::Expected<ExactAnswers> ask_exactly(const std::vector<ExactBody>& bodies,
                                         const std::vector<ExactQuestion>& questions) {
  if (bodies.empty()) return ExactAnswers{};
  const std::string file = bodies.front().source.file.string();
  const auto bytes = in_cad_process(file, [&](const base::IsolatedStage& stage) {
    return answers(bodies, questions, stage).map(bytes_of);
  });
  if (!bytes) return tl::unexpected(bytes.error());
  std::vector<double> mm(questions.size() + bodies.size());
  const bool whole = bytes->size() == mm.size() * sizeof(double);
  if (whole) std::memcpy(mm.data(), bytes->data(), bytes->size());
  if (!whole || std::ranges::any_of(mm, [](double value) { return std::isnan(value); })) {
    return base::failure(file + ": OpenCASCADE gave a garbled answer; the file may be damaged");
  }
  const auto split = mm.begin() + static_cast<std::ptrdiff_t>(questions.size());
  return ExactAnswers{{mm.begin(), split}, {split, mm.end()}};
}

}  // namespace pinjaw::part
