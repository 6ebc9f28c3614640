// Settings of a machine, and versions of its kernel image, each identified by its number: the writer writes
// them, and the judge must find them.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/services/configuration/property_files.hpp"

#include <random>
#include <string>

namespace tappet::bench {

/// Behind the last partition of the disk, which nothing else writes: the writer's marks, in the order of its
/// writes.
inline constexpr std::uint64_t marks_at_byte = 177ULL * 1024 * 1024;

struct Settings {
    Property<std::int64_t> number{0};
    Property<Sequence<double, 120>> values;

    static constexpr auto interface() {
        return facets(property<&Settings::number>("number", "", "of these settings"),
                      property<&Settings::values>("values", "N", "as many as their number asks for"));
    }
};

/// Saves like the firmware; the file takes one block or several. Returns the firmware's refusal.
inline std::string save_settings(std::string_view folder, std::int64_t number) {
    static Settings settings;
    static PropertyFiles files{""};
    static PropertyTransaction all;
    settings.number.set(number);
    Sequence<double, 120> values;
    for (std::int64_t i = 0; i < number * 37 % 120; ++i)
        static_cast<void>(values.push(static_cast<double>(number) + static_cast<double>(i) / 7));
    settings.values.set(values);
    ComponentRow row{.name = "settings", .type = &component_type<Settings>};
    row.properties = properties_file("settings.cpf");
    files.keep_in(folder);
    all.begin(row.name, *row.type, &settings);
    all.change_all();
    all.capture();
    return std::string{files.save(row, all).view()};
}

/// Random bytes of the version, so that any mix of two kernels is detected.
inline std::string kernel_of_version(std::uint32_t version) {
    std::mt19937_64 lot{version};
    std::string bytes(3'000'000 + version * 77'777 % 500'000, '\0');
    for (std::size_t at = 0; at < bytes.size(); at += 8) {
        std::uint64_t drawn = lot();
        for (std::size_t i = at; i < at + 8 && i < bytes.size(); ++i, drawn >>= 8)
            bytes[i] = static_cast<char>(drawn);
    }
    return bytes;
}

} // namespace tappet::bench
