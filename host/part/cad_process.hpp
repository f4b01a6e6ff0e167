#pragma once

#include <string>

#include "host/base/expected.hpp"
#include "host/base/isolated.hpp"

namespace pinjaw::part {

/// What OpenCASCADE may use on one file: 120 s and 2048 MB, or what PINJAW_CAD_SECONDS and
/// PINJAW_CAD_MEMORY_MB say. A sentence where one of them says nothing sensible.
base::Expected<base::IsolationLimits> cad_limits();

/// Runs `work`, which asks OpenCASCADE about `file`, in a process of its own (base::run_isolated): damaged
/// files crash it, make it loop and make it eat memory. OpenCASCADE is used nowhere else, so nothing of it is
/// locked or half changed where the process begins. A sentence that begins with the file's name where the
/// process fails; a refusal of `work` itself comes through as it is.
base::Expected<std::string> in_cad_process(const std::string& file, const base::IsolatedWork& work);

}  // namespace pinjaw::part
