// SPDX-License-Identifier: Apache-2.0
// The folder in which ci/setup stores its downloads, and a folder that deletes itself.
#pragma once

#include <filesystem>
#include <string>

namespace tappet::bench {

/// Returns the cache folder, by the same rule as ci/setup and toolchain/cache.cmake.
std::filesystem::path cache_folder();

/// A folder in the temporary folder; it exists as long as this object.
class WorkFolder {
public:
    explicit WorkFolder(const std::string& name, bool keep = false);
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
    bool keep_;
};

} // namespace tappet::bench
