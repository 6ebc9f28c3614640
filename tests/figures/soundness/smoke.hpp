// Runs a program of figures for a moment and looks whether its result is whole and sane. What it measured is
// no test.
#pragma once

#include "tests/figures/measure/read_result.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include <unistd.h>

namespace tappet::figures {

/// With --smoke and a file for its result; a test that fails says why.
inline Result run_smoke(const std::string& program) {
    const std::string file = testing::TempDir() + "figures-" + std::to_string(::getpid()) + ".json";
    const std::string command = "'" + program + "' --smoke --json '" + file + "' >/dev/null 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    auto read = read_result(file);
    ::unlink(file.c_str());
    EXPECT_TRUE(read.has_value()) << (read ? std::string{} : read.error());
    return read ? *read : Result{};
}

/// Each figure has a row of ours and something beside it, each with samples that are in order.
inline void expect_sound(const Result& result) {
    for (const Figure& figure : result.figures) {
        bool has_ours = false;
        EXPECT_GE(figure.rows.size(), 2u) << figure.id;
        for (const Row& row : figure.rows) {
            has_ours |= row.role == Standing::ours;
            const Summary& s = row.summary;
            EXPECT_GT(s.count, 0u) << figure.id << ": " << row.name;
            EXPECT_GT(s.median, 0) << figure.id << ": " << row.name;
            EXPECT_LE(s.median, s.p99) << figure.id << ": " << row.name;
            EXPECT_LE(s.p99, s.p999) << figure.id << ": " << row.name;
            EXPECT_LE(s.p999, s.max) << figure.id << ": " << row.name;
        }
        EXPECT_TRUE(has_ours) << figure.id;
    }
    for (const Goal& goal : result.goals) {
        EXPECT_TRUE(std::isfinite(goal.measured)) << goal.text;
        EXPECT_GT(goal.limit, 0) << goal.text;
    }
}

} // namespace tappet::figures
