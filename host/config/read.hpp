#pragma once

#include <filesystem>

#include "host/base/diagnostics.hpp"
#include "host/model/cell.hpp"
#include "host/model/controller.hpp"
#include "host/model/kit.hpp"
#include "host/model/profile.hpp"
#include "host/model/sequence.hpp"
#include "host/model/task.hpp"

/// Files people write (YAML, or JSON, which is YAML) into model values. Every reader returns the whole value,
/// or every mistake of the file and of the files it names, each with file:line:column and key path. Relative
/// paths inside a file start at the folder that holds it.
namespace pinjaw::config {

/// A value of the model, or all the mistakes in its files.
template <class T>
using Read = base::Checked<T>;

/// A pin kit. Checks what one kit can get wrong by itself: overlapping pins, protrusion that would reach the
/// other gripper's plate (DESIGN 3.1 no. 8), empty ranges.
Read<model::Kit> read_kit(const std::filesystem::path& path);

/// A profile part. Loops must close, not cross or touch, the first counter-clockwise, the others clockwise
/// inside it.
Read<model::Profile> read_profile(const std::filesystem::path& path);

/// A planning job with its kit, material and (for a profile part) its profile.
Read<model::Task> read_task(const std::filesystem::path& path);

/// A workcell with the tasks of all its stations.
Read<model::Cell> read_cell(const std::filesystem::path& path);

/// A simulated controller with its kit.
Read<model::Controller> read_controller(const std::filesystem::path& path);

/// A scripted run with its cell.
Read<model::Sequence> read_sequence(const std::filesystem::path& path);

}  // namespace pinjaw::config
