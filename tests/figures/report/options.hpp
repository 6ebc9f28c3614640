// The options that ci/figures passes to the report.
#pragma once

#include <expected>
#include <string>
#include <vector>

namespace tappet::figures {

struct ReportOptions {
    std::string programs = {};     ///< --programs DIR: a build's tests/figures
    std::string output = {};       ///< --output DIR
    std::string against = {};      ///< --against DIR: the other build's tests/figures
    std::string against_name = {}; ///< --against-name TEXT
    std::vector<std::string> only = {};
    std::string setting = "short"; ///< --long, --brief, --smoke
    bool counts = true;            ///< --no-counts
    double limit = 0;              ///< --limit SECONDS of each program; 0: depends on the setting
    std::size_t rounds = 6;        ///< --rounds N
    double margin_percent = 5;     ///< --margin PERCENT
};

/// Otherwise one sentence: the wrong word, and the valid ones.
std::expected<ReportOptions, std::string> read_report_options(const std::vector<std::string>& words);

} // namespace tappet::figures
