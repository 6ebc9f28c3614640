// All faults of an EDS or DCF file.
#include "drivers/canopen/eds_faults.hpp"

#include "drivers/canopen/eds_notes.hpp"
#include "drivers/canopen/eds_reader.hpp"

#include <algorithm>
#include <tuple>

namespace tappet::canopen {

std::vector<EdsFault> eds_faults(const SourceText& file) {
    std::vector<EdsFault> all;
    for (const FileNote& note : detail::EdsReader{file}.notes)
        all.push_back({note.line, std::string{meaning(note).view()}, std::string{effect(note).view()},
                       note.flaws == flaw::file});
    std::ranges::sort(all, {}, [](const EdsFault& each) { return std::tie(each.line, each.meaning); });
    return all;
}

} // namespace tappet::canopen
