// Results made by hand, in the form that programs of figures write.
#pragma once

#include "tests/figures/report/run.hpp"

namespace tappet::figures {

inline Row row(const std::string& name, Standing role, double median) {
    return {name, role, {median, median, median * 2, median * 3, median * 4, 100}};
}

/// One figure of ours, one floor and one peer.
inline Result result(const std::string& program, double ours, double floor = 10, double peer = 40) {
    Result result{program};
    result.figures.push_back({program + ".write",
                              "a write",
                              "ns",
                              "thesis 4.4",
                              "mean of 64",
                              {row("port", Standing::ours, ours), row("copy", Standing::floor, floor),
                               row("mutex", Standing::peer, peer)}});
    return result;
}

inline ProgramRun ran(Result result) {
    ProgramRun run{result.program};
    run.result = std::move(result);
    return run;
}

} // namespace tappet::figures
