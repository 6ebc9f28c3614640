// The command line of the demo.
#pragma once

#include <cstdint>
#include <expected>
#include <string>

namespace tappet::demo {

struct Options {
    std::string firmware; // stripped, as it is flashed
    std::string plant;
    std::string browser;    // tappet-browse
    std::string behaviours; // the folder of the scripts that are loaded on the way
    std::string init;       // PID 1 of the bench
    std::string summary;
    std::int64_t picks = 200;
    std::uint64_t seed = 1;
    bool plain = false;
    bool help = false;
};

/// The error says which word is wrong and how to put it right.
[[nodiscard]] std::expected<Options, std::string> parse_options(int count, const char* const* words);
[[nodiscard]] std::string usage();

} // namespace tappet::demo
