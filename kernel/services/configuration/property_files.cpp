// Reads and writes the text of properties files.
#include "kernel/services/configuration/property_files.hpp"

#include "kernel/base/value_text.hpp"
#include "kernel/os/file.hpp"
#include "kernel/os/terminal.hpp"

#include <algorithm>
#include <cstring>

namespace tappet {

namespace {

Sentence no_directory(const ComponentRow& row) noexcept {
    return Sentence{"component \"", row.name, "\": there is no directory for its properties file \"",
                    row.properties.name,
                    "\"; name one by --properties, or as the board's properties_directory"};
}

std::size_t index_of(const ComponentRow& row, std::string_view property) noexcept {
    const auto found = std::ranges::find(row.type->facets, property, &Facet::name);
    return static_cast<std::size_t>(found - row.type->facets.begin());
}

/// The values that the row sets, as they stand before its file is read.
struct StatedValues {
    alignas(PropertyTransaction::alignment) std::array<std::byte, PropertyTransaction::max_bytes> bytes{};

    /// Calls use(property's index, place of its copy) for each setting.
    template <class Use>
    void each(const ComponentRow& row, Use&& use) noexcept {
        std::size_t used = 0;
        for (const PropertyRow& setting : row.settings) {
            const std::size_t index = index_of(row, setting.name);
            use(index, bytes.data() + used);
            used += PropertyTransaction::bytes_for(row.type->facets[index]);
        }
    }
};

/// A value that somebody wrote into the table and that has no effect is told.
void tell_overridden(const ComponentRow& row, StatedValues& stated, PropertyTransaction& now) noexcept {
    stated.each(row, [&](std::size_t index, const std::byte* before) {
        const Facet& facet = row.type->facets[index];
        const std::byte* const after = now.change(index);
        if (std::equal(before, before + facet.type->size, after)) return;
        std::array<char, 64> from{}, to{};
        const std::size_t old_length = format_value(*facet.type, before, from);
        const std::size_t new_length = format_value(*facet.type, after, to);
        os::print(Sentence{
            "component \"", row.name, "\": \"", facet.name, "\" is ",
            new_length == 0 ? std::string_view{"another list"} : std::string_view{to.data(), new_length},
            " from its file \"", row.properties.name, "\", not ",
            old_length == 0 ? std::string_view{"the list"} : std::string_view{from.data(), old_length},
            " as its row sets; remove it from the file, or set the same\n"}
                      .view());
    });
}

} // namespace

PropertyStore PropertyFiles::store() noexcept {
    return {this,
            [](void* self, const ComponentRow& row, PropertyTransaction& into) {
                return static_cast<PropertyFiles*>(self)->load(row, into);
            },
            [](void* self, const ComponentRow& row, const PropertyTransaction& from) {
                return static_cast<PropertyFiles*>(self)->save(row, from);
            }};
}

bool PropertyFiles::name_path(std::string_view directory, std::string_view name) noexcept {
    if (directory.size() + 1 + name.size() > longest_path) return false;
    auto end = std::copy(directory.begin(), directory.end(), path_.begin());
    *end++ = '/';
    end = std::copy(name.begin(), name.end(), end);
    *end = '\0';
    return true;
}

Sentence PropertyFiles::load(const ComponentRow& row, PropertyTransaction& into) noexcept {
    if (!keeps()) return row.properties.may_be_missing ? Sentence{} : no_directory(row);
    // Without a directory each optional file is missing, and only the saving at the end would fail.
    if (name_path(directory_, ".") && os::read_file(path_.data(), {}).result == os::FileRead::missing)
        return Sentence{
            directory_, ": component \"", row.name,
            "\": this directory of its properties file does not exist; make it, or name another one by "
            "--properties"};
    StatedValues stated;
    stated.each(row, [&](std::size_t index, std::byte* copy) {
        std::memcpy(copy, into.change(index), row.type->facets[index].type->size);
    });
    auto found = load_from(directory_, row, nullptr, into);
    if (!found) return found.error();
    if (!older_.empty()) {
        const auto there = load_from(older_, row, left_out_, into);
        if (!there) return there.error();
        *found |= *there;
    }
    tell_overridden(row, stated, into);
    if (*found || row.properties.may_be_missing || !name_path(directory_, row.properties.name)) return {};
    return Sentence{
        std::string_view{path_.data()},
        ": component \"",
        row.name,
        "\": its properties file is missing; put it there, name its directory by --properties, or "
        "say properties_file(\"",
        row.properties.name,
        "\", optional) in its row"};
}

std::expected<bool, Sentence> PropertyFiles::load_from(std::string_view directory, const ComponentRow& row,
                                                       LeftOut left_out, PropertyTransaction& into) noexcept {
    if (!name_path(directory, row.properties.name))
        return std::unexpected(Sentence{"component \"", row.name, "\": the path of its properties file \"",
                                        row.properties.name,
                                        "\" is too long; name a shorter properties directory"});
    const std::string_view path{path_.data()};
    const os::FileText read = os::read_file(path_.data(), text_);
    switch (read.result) {
    case os::FileRead::good:
        if (const Sentence fault = read_cpf({text_.data(), read.length}, path, into, left_out, &forms_);
            !fault.empty())
            return std::unexpected(fault);
        return true;
    case os::FileRead::missing: return false;
    case os::FileRead::too_large:
        return std::unexpected(Sentence{path, ": component \"", row.name, "\": the file has more than ",
                                        max_cpf_bytes,
                                        " bytes; check that it is a properties file, or shorten it"});
    case os::FileRead::unreadable: break;
    }
    return std::unexpected(Sentence{path, ": component \"", row.name,
                                    "\": its properties file cannot be read; look at its permissions"});
}

Sentence PropertyFiles::save(const ComponentRow& row, const PropertyTransaction& from) noexcept {
    if (!keeps()) return no_directory(row);
    if (!name_path(directory_, row.properties.name))
        return Sentence{"component \"", row.name, "\": the path of its properties file \"",
                        row.properties.name, "\" is too long; name a shorter properties directory"};
    // A component may set a value that nobody checked; the next start would refuse to arm with it.
    if (const Sentence refused = from.check(); !refused.empty())
        return Sentence{std::string_view{path_.data()},
                        ": component \"",
                        row.name,
                        "\": ",
                        refused,
                        "; its properties are not saved and the old file remains"};
    Sentence fault;
    const std::size_t length = write_cpf(from, text_, fault, {forms_.begin(), forms_.size()});
    if (!fault.empty()) return fault;
    if (os::replace_file(path_.data(), {text_.data(), length})) return {};
    return Sentence{
        std::string_view{path_.data()}, ": component \"", row.name,
        "\": its properties cannot be saved and the old file remains; look at the directory's permissions "
        "and its free space"};
}

} // namespace tappet
