// SPDX-License-Identifier: Apache-2.0
// The contents of an image, by package and version, in the format CycloneDX.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tappet::image {

struct Component {
    std::string name{};
    std::string version{};
    std::string kind = "library"; ///< CycloneDX's: "operating-system", "firmware", "library"
    bool is_debian = true;
    friend auto operator<=>(const Component&, const Component&) = default;
};

/// Returns, for every file that the linker used for a program, by its list (ld --dependency-file), the Debian
/// package that it belongs to. Foreign libraries built here have their version in `cache`. A file without a
/// package is a fault: nothing is left out.
[[nodiscard]] std::vector<Component> linked_into(const std::filesystem::path& list,
                                                 const std::filesystem::path& cache);

/// Returns the installed package's version.
[[nodiscard]] Component debian_package(const std::string& name, const std::string& kind = "library");

/// Writes the list sorted, each entry once. No date and no random number: the same image has the same list.
[[nodiscard]] std::string bill_of_materials(const std::string& machine, const std::string& board,
                                            std::uint32_t version, std::vector<Component> components);

} // namespace tappet::image
