// SPDX-License-Identifier: Apache-2.0
// Where ci/setup keeps what it fetched, and a folder that is gone afterwards.
#pragma once

#include <filesystem>
#include <string>

namespace tappet::bench {

/// The same rule as in ci/setup and toolchain/cache.cmake.
std::filesystem::path cache_folder();

/// In the temporary folder, for as long as this lives.
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
