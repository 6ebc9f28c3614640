// SPDX-License-Identifier: Apache-2.0
// What is inside an image, by package and version, in the form CycloneDX.
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

/// Of every file that the linker took for a program, from the list that it wrote (ld --dependency-file): the
/// Debian package it belongs to. Foreign libraries that are built here have their version in `cache`. A file
/// of nobody is a fault: nothing is left out.
[[nodiscard]] std::vector<Component> linked_into(const std::filesystem::path& list,
                                                 const std::filesystem::path& cache);

/// The installed package's version.
[[nodiscard]] Component debian_package(const std::string& name, const std::string& kind = "library");

/// Sorted, each once. No date and no random number: the same image has the same list.
[[nodiscard]] std::string bill_of_materials(const std::string& machine, const std::string& board,
                                            std::uint32_t version, std::vector<Component> components);

} // namespace tappet::image
