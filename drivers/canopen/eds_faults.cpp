// Reads an EDS or DCF file at run time, with room for all its faults.
#include "drivers/canopen/eds_faults.hpp"

#include "drivers/canopen/eds_notes.hpp"
#include "drivers/canopen/eds_reader.hpp"

#include <algorithm>
#include <memory>
#include <tuple>

namespace tappet::canopen {

namespace {

template <std::size_t most> std::vector<EdsFault> read(const SourceText& file) {
    const auto read = std::make_unique<detail::EdsReader<most, most>>(file);
    std::vector<EdsFault> all;
    for (const FileNote& note : read->notes)
        all.push_back({note.line, std::string{meaning(note).view()}, std::string{effect(note).view()},
                       note.flaws == flaw::file});
    std::ranges::sort(all, {}, [](const EdsFault& each) { return std::tie(each.line, each.meaning); });
    return all;
}

} // namespace

std::vector<EdsFault> eds_faults(const SourceText& file) {
    constexpr std::size_t few = 1000, most = 20'000;
    const std::size_t room = detail::eds_room(file.text);
    if (room > most)
        return {{1, std::string{Sentence{"it may have ", room, " objects, more than ", most}.view()},
                 "every node of this file", true}};
    return room > few ? read<most>(file) : read<few>(file);
}

} // namespace tappet::canopen
