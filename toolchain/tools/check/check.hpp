// tappet check: reads files of other makers by the readers of the compiler, and tells all that is wrong in
// them: file, line, who is affected, and meaning.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tappet::checking {

enum class Weight {
    note,       ///< no machine suffers from it
    fault,      ///< a map that takes this part of the file is refused
    unreadable, ///< no map can be made from the file
};

struct Finding {
    unsigned line = 0;
    Weight weight = Weight::note;
    std::string meaning{};
    std::vector<std::string> affects{}; ///< nodes of a DBC file; rows, for an EDS file; empty: nobody
    unsigned more = 0;                  ///< further lines with the same meaning
};

/// Returns what is wrong in a DBC file, in the order of its lines; equal notes are one.
[[nodiscard]] std::vector<Finding> check_dbc(std::string_view text);
/// Returns what is wrong in an EDS or DCF file, in the order of its lines.
[[nodiscard]] std::vector<Finding> check_eds(std::string_view text);

struct Report {
    std::string text{};
    std::string failure{}; ///< why nothing was checked
    bool has_faults = false;
};
/// Checks these files, and in folders all files of known kinds. The text is a table and a verdict for each
/// file. `node`: the machine's own; faults of a DBC file that affect only others are notes.
/// Empty: all nodes count.
[[nodiscard]] Report report_on(const std::vector<std::string>& paths, const std::string& node = {});

} // namespace tappet::checking
