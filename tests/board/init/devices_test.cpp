// A kernel's module without its maker's signature: that and no byte more is taken away.
#include "board/init/devices.hpp"

#include <gtest/gtest.h>

namespace tappet::init {
namespace {

std::string signed_module(const std::string& module, const std::string& signature, std::size_t said_length) {
    std::string row(8, '\2');
    for (const int shift : {24, 16, 8, 0}) row += static_cast<char>(said_length >> shift);
    return module + signature + row + "~Module signature appended~\n";
}

TEST(Module, is_what_stands_before_its_signature) {
    const std::string module = "\177ELF and so on", signature(683, 's');
    EXPECT_EQ(without_signature(signed_module(module, signature, signature.size())), module);
}

TEST(Module, without_a_signature_stays_as_it_is) {
    EXPECT_EQ(without_signature("\177ELF"), "\177ELF");
    EXPECT_EQ(without_signature(""), "");
}

TEST(Module, whose_signature_says_that_it_is_longer_than_the_file_stays_as_it_is) {
    for (const std::size_t length : {20u, 0xffffffffu}) {
        const std::string torn = signed_module("\177ELF", "s", length);
        EXPECT_EQ(without_signature(torn), torn);
    }
    EXPECT_EQ(without_signature("~Module signature appended~\n"), "~Module signature appended~\n");
}

} // namespace
} // namespace tappet::init
