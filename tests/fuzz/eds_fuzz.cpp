// Any bytes as an EDS file: the reader refuses with a sentence that names a line, or gives objects in order
// and within the limits of their types; each of its notes is a sentence with a line of the file.
#include "drivers/canopen/eds_notes.hpp"
#include "drivers/canopen/eds_reader.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace tappet::canopen;
using tappet::fuzz::demand;

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text{reinterpret_cast<const char*>(data), size};
    const detail::EdsReader read{tappet::SourceText{"x.eds", text}};
    if (!read.fault.empty()) {
        demand(read.fault.view().starts_with("x.eds:"));
        demand(read.fault.size() < tappet::Sentence::capacity);
        return 0;
    }
    const Dictionary dictionary = read.dictionary();
    for (std::size_t i = 0; i < read.objects.size(); ++i) {
        const Object& object = read.objects[i];
        demand(i == 0 || read.objects[i - 1].at < object.at);
        demand(dictionary.find(object.at) == &object);
        for (const Number& each : {object.value, object.low, object.high})
            demand(each.bits == low_bits(each.bits, bits_of(object.type)));
        demand(!object.value.given || within_limits(object, object.value.of(1), 1) || !read.notes.empty());
        demand(object.flaws == 0 || !read.notes.empty());
        tappet::Sentence name;
        add_readable(name, object.name.substr(0, 60));
        for (std::string_view rest = name.view(); !rest.empty();
             rest.remove_prefix(tappet::utf8_length(rest)))
            demand(tappet::utf8_length(rest) != 0);
    }
    const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1;
    for (const FileNote& note : read.notes) {
        demand(note.line >= 1 && note.line <= lines);
        demand(note.other <= lines || note.kind == FileNote::Kind::sub_number);
        demand(!meaning(note).empty() && meaning(note).size() < 300 && !effect(note).empty());
    }
    demand(!read.objects.empty());
    return 0;
}
