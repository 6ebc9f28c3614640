// The DBC files of this folder.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace tappet::can {

inline std::string contents_of(const std::string& name) {
    std::ifstream file{TAPPET_DBC_FILES "/" + name, std::ios::binary};
    EXPECT_TRUE(file) << name;
    return {std::istreambuf_iterator<char>{file}, {}};
}

} // namespace tappet::can
