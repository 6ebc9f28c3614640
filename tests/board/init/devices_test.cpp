// Removing the signature of a kernel module removes exactly those bytes.
#include "board/init/devices.hpp"

#include <gtest/gtest.h>

namespace tappet::init {
namespace {

std::string signed_module(const std::string& module, const std::string& signature, std::size_t said_length) {
    std::string row(8, '\2');
    for (const int shift : {24, 16, 8, 0}) row += static_cast<char>(said_length >> shift);
    return module + signature + row + "~Module signature appended~\n";
}

TEST(Module, ends_before_its_signature) {
    const std::string module = "\177ELF and so on", signature(683, 's');
    EXPECT_EQ(without_signature(signed_module(module, signature, signature.size())), module);
}

TEST(Module, stays_unchanged_without_a_signature) {
    EXPECT_EQ(without_signature("\177ELF"), "\177ELF");
    EXPECT_EQ(without_signature(""), "");
}

TEST(Module, stays_unchanged_when_its_signature_claims_too_many_bytes) {
    for (const std::size_t length : {20u, 0xffffffffu}) {
        const std::string torn = signed_module("\177ELF", "s", length);
        EXPECT_EQ(without_signature(torn), torn);
    }
    EXPECT_EQ(without_signature("~Module signature appended~\n"), "~Module signature appended~\n");
}

} // namespace
} // namespace tappet::init
