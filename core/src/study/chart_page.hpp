// The chart as a page that opens from disk: nothing is fetched, nothing runs.
#pragma once

#include <string>

#include "study/chart.hpp"

namespace grit {

std::string chart_page(const Chart& chart);

}  // namespace grit
