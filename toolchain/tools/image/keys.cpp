// SPDX-License-Identifier: Apache-2.0
// libsodium and openssl make the pairs; osslsigncode, under a fixed clock, signs UEFI programs.
#include "toolchain/tools/image/keys.hpp"

#include "toolchain/tools/image/tool.hpp"

#include <algorithm>

namespace tappet::image {

namespace fs = std::filesystem;

namespace {

struct Pair {
    const char* name;
    const char* subject;
};
/// In the order in which a box's setup accepts them: the last one locks it.
constexpr Pair pairs[] = {
    {"db", "Tappet images"}, {"KEK", "Tappet key exchange key"}, {"PK", "Tappet platform key"}};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string file(const fs::path& folder, const std::string& name, const char* kind) {
    return (folder / (name + kind)).string();
}

} // namespace

void write_keys(const fs::path& folder) {
    if (can_sign(folder))
        throw Fault((folder / "secret").string() + " is there already; name another folder");
    fs::create_directories(folder);
    fs::permissions(folder, fs::perms::owner_all);
    const box::KeyPair keys = box::new_keys();
    write_file(folder / "public", box::digits_of(keys.open) + "\n");
    write_file(folder / "secret", {reinterpret_cast<const char*>(keys.secret.data()), keys.secret.size()});
    fs::permissions(folder / "secret", fs::perms::owner_read);
    for (const auto& [name, subject] : pairs) {
        run_tool({"openssl", "req", "-new", "-x509", "-newkey", "rsa:2048", "-nodes", "-sha256", "-days",
                  "9131", "-subj", std::string{"/CN="} + subject, "-keyout", file(folder, name, ".key"),
                  "-out", file(folder, name, ".crt")});
        fs::permissions(file(folder, name, ".key"), fs::perms::owner_read);
        run_tool({"openssl", "x509", "-outform", "DER", "-in", file(folder, name, ".crt"), "-out",
                  file(folder, name, ".cer")});
    }
}

std::string public_key(const fs::path& folder) {
    const std::string digits = first_line(read_file(folder / "public"));
    if (const auto key = box::key_of(digits); !key)
        throw Fault((folder / "public").string() + ": " + key.error());
    return digits;
}

bool can_sign(const fs::path& folder) { return fs::exists(folder / "secret"); }

box::SecretKey secret_key(const fs::path& folder) {
    box::SecretKey key{};
    const std::string bytes = read_file(folder / "secret");
    if (bytes.size() != key.size())
        throw Fault((folder / "secret").string() + " is not a secret key; make new keys");
    std::ranges::copy(bytes, key.begin());
    return key;
}

void sign_program(const fs::path& program, const fs::path& folder) {
    fs::path to = program;
    to += ".signed";
    fs::remove(to);
    run_tool({"osslsigncode", "sign", "-certs", file(folder, "db", ".crt"), "-key",
              file(folder, "db", ".key"), "-h", "sha256", "-st", std::string{standing_clock}, "-in",
              program.string(), "-out", to.string()});
    fs::rename(to, program);
}

std::vector<fs::path> certificates(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& [name, subject] : pairs) files.push_back(file(folder, name, ".cer"));
    return files;
}

} // namespace tappet::image
