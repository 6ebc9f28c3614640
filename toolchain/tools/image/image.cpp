// SPDX-License-Identifier: Apache-2.0
// Root file system, unified kernel image, disk.
#include "toolchain/tools/image/image.hpp"

#include "board/box/facts.hpp"
#include "board/box/update.hpp"
#include "toolchain/tools/bench/folders.hpp"
#include "toolchain/tools/bench/initramfs.hpp"
#include "toolchain/tools/image/disk.hpp"
#include "toolchain/tools/image/kernel_modules.hpp"
#include "toolchain/tools/image/sbom.hpp"
#include "toolchain/tools/image/tool.hpp"

#include <algorithm>

namespace tappet::image {

namespace fs = std::filesystem;

namespace {

constexpr const char* boot_guard = "/usr/lib/x86_64-linux-gnu/efibootguard/";

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Everything inside: kernel, loader, what the firmware is linked of, Tappet itself. Init is linked of a part
/// of that.
std::string bill_of(const Request& request, const box::Facts& facts, const std::string& release) {
    fs::path list = request.firmware; // <name>.stripped
    std::vector<Component> parts = linked_into(list.replace_extension("inputs"), request.kernel / "../..");
    // Init's list lies beside it.
    fs::path of_init = request.init;
    for (Component& each : linked_into(of_init += ".inputs", request.kernel / "../.."))
        parts.push_back(std::move(each));
    const std::string version = first_line(read_file(request.kernel / "version"));
    parts.push_back({"linux-image-" + release, version, "operating-system"});
    parts.push_back(debian_package("efibootguard", "firmware"));
    parts.push_back({"tappet", TAPPET_VERSION, "framework", false});
    return bill_of_materials(facts.one("machine"), facts.one("board"), request.version, std::move(parts));
}

std::string joined(const box::Words& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

std::string command_line_of(const box::Facts& facts) {
    std::string text;
    for (const box::Words& console : facts.all("console")) text += "console=" + console[0] + " ";
    for (const box::Words& line : facts.all("kernel")) text += joined(line);
    return text + " rdinit=/init";
}

} // namespace

void write_keys(const fs::path& folder) {
    if (fs::exists(folder / "secret"))
        throw Fault((folder / "secret").string() + " is there already; name another folder");
    fs::create_directories(folder);
    const box::KeyPair keys = box::new_keys();
    write_file(folder / "public", box::digits_of(keys.open) + "\n");
    write_file(folder / "secret", {reinterpret_cast<const char*>(keys.secret.data()), keys.secret.size()});
    fs::permissions(folder / "secret", fs::perms::owner_read);
}

Written write_image(const Request& request) {
    if (!fs::exists(request.kernel / "vmlinuz"))
        throw Fault("there is no kernel for a box at " + request.kernel.string() +
                    "; run ci/setup once as root");
    if (!fs::exists(request.firmware))
        throw Fault("there is no firmware at " + request.firmware.string() + "; build it first");
    std::string lines = run_tool({fs::absolute(request.firmware).string(), "--board"});
    const box::Facts facts{lines};
    if (facts.one("board").empty())
        throw Fault(request.firmware.string() +
                    " does not say its board; it is no firmware of Tappet, or an old one");
    if (facts.all("console").empty())
        throw Fault("board \"" + facts.one("board") +
                    "\" says nothing of an image; give it .image with modules and consoles");
    lines += "image " + std::to_string(request.version) + "\n";
    box::SecretKey secret{};
    if (!request.keys.empty()) {
        const std::string open = first_line(read_file(request.keys / "public"));
        if (const auto key = box::key_of(open); !key)
            throw Fault((request.keys / "public").string() + ": " + key.error());
        lines += "key " + open + "\n";
        const std::string bytes = read_file(request.keys / "secret");
        if (bytes.size() != secret.size())
            throw Fault((request.keys / "secret").string() + " is no secret key; write keys anew");
        std::ranges::copy(bytes, secret.begin());
    }
    if (!request.plant.empty()) lines += "plant /bin/plant " + request.plant_words + "\n";

    std::vector<std::string> rows;
    for (const box::Words& row : facts.all("module")) rows.push_back(joined(row));
    const std::string release = first_line(read_file(request.kernel / "release"));
    const std::string bill = bill_of(request, facts, release);
    const KernelModules modules = choose_modules(rows, request.kernel / "lib/modules" / release);

    const bench::WorkFolder work("tappet-image");
    fs::create_directories(request.folder);
    bench::Initramfs root{work / "root.cpio"};
    root.add(request.init, "/init");
    root.add(request.firmware, "/bin/firmware");
    if (!request.plant.empty()) root.add(request.plant, "/bin/plant");
    root.add_text("/etc/tappet/box", lines);
    root.add_text("/etc/tappet/modules", modules.table);
    for (const auto& [name, file] : modules.files) root.add(file, "/modules/" + name + ".ko");
    for (const char* folder : {"/proc", "/sys", "/tmp", "/run"}) root.add_folder(folder);
    root.finish();

    Written written;
    written.bill = request.folder / "sbom.cdx.json";
    write_file(written.bill, bill);
    written.disk = request.folder / "disk.img";
    written.kernel = request.folder / "tappet.efi";
    written.root = request.folder / "root.cpio.zst";
    written.command_line = command_line_of(facts);
    run_tool({"zstd", "-q", "-f", "-19", "--no-progress", (work / "root.cpio").string(), "-o",
              written.root.string()});
    run_tool({"bg_gen_unified_kernel", std::string{boot_guard} + "kernel-stubx64.efi",
              (request.kernel / "vmlinuz").string(), written.kernel.string(), "--cmdline",
              written.command_line, "--initrd", written.root.string()});
    write_disk(written.disk, std::string{boot_guard} + "efibootguardx64.efi", written.kernel,
               request.watchdog_s, work / "");
    if (!request.keys.empty()) {
        written.update = request.folder / "update.tap";
        const box::Manifest manifest{facts.one("machine"), facts.one("board"), request.version,
                                     request.least};
        write_file(written.update, box::encode({manifest, read_file(written.kernel)}, secret));
    }
    written.kernel_bytes = fs::file_size(request.kernel / "vmlinuz");
    written.root_bytes = fs::file_size(written.root);
    written.slot_bytes = fs::file_size(written.kernel);
    written.modules = modules.files.size();
    return written;
}

} // namespace tappet::image
