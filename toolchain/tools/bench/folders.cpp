// SPDX-License-Identifier: Apache-2.0
#include "toolchain/tools/bench/folders.hpp"

#include "toolchain/tools/bench/initramfs.hpp"

#include <cstdlib>

namespace tappet::bench {

namespace fs = std::filesystem;

fs::path cache_folder() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value != nullptr ? value : "");
    };
    if (const std::string own = variable("TAPPET_CACHE"); !own.empty()) return own;
    if (const std::string shared = variable("XDG_CACHE_HOME"); !shared.empty())
        return fs::path(shared) / "tappet";
    const std::string home = variable("HOME");
    return fs::path(home.empty() ? "/root" : home) / ".cache/tappet";
}

WorkFolder::WorkFolder(const std::string& name, bool keep) : keep_(keep) {
    std::string pattern = (fs::temp_directory_path() / (name + "-XXXXXX")).string();
    if (::mkdtemp(pattern.data()) == nullptr)
        throw BenchError("cannot make a temporary folder '" + pattern + "'; check its rights and TMPDIR");
    path_ = pattern;
}

WorkFolder::~WorkFolder() {
    std::error_code ignored;
    if (!keep_) fs::remove_all(path_, ignored);
}

} // namespace tappet::bench
