// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "doorforge/core/svg_plot.h"
#include "doorforge/reinforce/ppo_files.h"

namespace doorforge::internal {

/// A number that a page has in its head.
struct CurveFigure {
  std::string number;
  std::string of;
};

struct CurveChart {
  const char* title;
  const char* axis;
  page::PlotPoints points;
};

/// What the page of a training shows.
struct CurvePage {
  const char* name;    ///< "ppo".
  const char* method;  ///< "PPO from states".
  bool is_done;
  std::vector<CurveFigure> figures;
  const char* x_axis;
  double x_most;
  std::vector<CurveChart> charts;
};

/// Writes the page of which PpoPage() says what it is.
std::string TextOf(const CurvePage& page, const PpoOrigin& origin);

/// A JSON object a row, on lines of their own, with all columns; `name` is what a row is called.
template <class Row, class Columns>
std::string LinesOfRows(const std::vector<Row>& rows, const Columns& columns, const char* name) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += std::string("{\"") + name + "\": " + std::to_string(i + 1);
    for (const auto& column : columns) {
      char number[64];
      std::snprintf(number, sizeof number, "\": %.9g", rows[i].*column.value);
      text.append(", \"").append(column.name).append(number);
    }
    text += "}\n";
  }
  return text;
}

}  // namespace doorforge::internal
