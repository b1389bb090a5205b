// Settings of runs without effect, which studies and calibrations warn of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "input/document.hpp"
#include "lint/unused_setting.hpp"
#include "lint/without_effect.hpp"

namespace grit {

/// All settings of a run without effect; none if it cannot begin, of which the run says more.
std::vector<UnusedSetting> idle_settings(const SceneSource& source);

/// Why a value has no effect: it, or what it belongs to, is an idle setting. Nothing if it is not.
std::optional<std::string> why_idle(const std::vector<UnusedSetting>& idle, const std::string& pointer);

/// Says on standard error that a value of a file has no effect.
void warn_of_idle(const Document& written, const std::string& where, const std::string& why);

}  // namespace grit
