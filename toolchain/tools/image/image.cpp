// SPDX-License-Identifier: Apache-2.0
// Builds the root file system, the unified kernel image and the disk.
#include "toolchain/tools/image/image.hpp"

#include "board/box/disk.hpp"
#include "board/box/facts.hpp"
#include "board/box/update.hpp"
#include "kernel/base/version.hpp"
#include "toolchain/tools/bench/folders.hpp"
#include "toolchain/tools/bench/initramfs.hpp"
#include "toolchain/tools/image/disk.hpp"
#include "toolchain/tools/image/kernel_modules.hpp"
#include "toolchain/tools/image/keys.hpp"
#include "toolchain/tools/image/sbom.hpp"
#include "toolchain/tools/image/tool.hpp"
#include "toolchain/tools/image/unified_kernel.hpp"

#include <cstdlib>

namespace tappet::image {

namespace fs = std::filesystem;

namespace {

constexpr const char* boot_guard = "/usr/lib/x86_64-linux-gnu/efibootguard/";

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Lists the contents: kernel, loader, the libraries linked into the firmware, Tappet itself. Init is linked
/// from a part of those.
std::string bill_of(const Request& request, const box::Facts& facts, const std::string& release) {
    fs::path list = request.firmware; // <name>.stripped
    std::vector<Component> parts = linked_into(list.replace_extension("inputs"), request.kernel / "../..");
    // Init's list is beside it.
    fs::path of_init = request.init;
    for (Component& each : linked_into(of_init += ".inputs", request.kernel / "../.."))
        parts.push_back(std::move(each));
    const std::string version = first_line(read_file(request.kernel / "version"));
    parts.push_back({"linux-image-" + release, version, "operating-system"});
    parts.push_back(debian_package("efibootguard", "firmware"));
    parts.push_back(debian_package("e2fsck-static", "application"));
    parts.push_back({"tappet", std::string{framework_version}, "framework", false});
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

namespace {

/// The files that sign() finds in the folder.
struct Folder {
    fs::path at;
    [[nodiscard]] fs::path disk() const { return at / "disk.img"; }
    [[nodiscard]] fs::path kernel() const { return at / "tappet.efi"; }
    [[nodiscard]] fs::path loader() const { return at / "loader.efi"; }
    [[nodiscard]] fs::path update() const { return at / "update.tap"; }
    /// Without a signature; followed by the watchdog's time.
    [[nodiscard]] fs::path header() const { return at / "manifest"; }
};

/// Writes the disk and the update from the files in the folder, signed if there are keys.
void finish(const Folder& folder, const fs::path& keys) {
    const std::string known = read_file(folder.header());
    DiskParts parts{.loader = folder.loader(), .kernel = folder.kernel(), .header = {}, .certificates = {}};
    box::Update update{box::manifest_of(known), {}, {}};
    parts.watchdog_s = static_cast<std::uint16_t>(std::strtoul(
        box::Facts{std::string_view{known}.substr(box::update_header_bytes)}.one("watchdog").c_str(), nullptr,
        10));
    if (keys.empty()) {
        parts.header = box::header_of({update.manifest, read_file(folder.kernel()), {}}, nullptr);
    } else {
        for (const fs::path& program : {folder.loader(), folder.kernel()}) sign_program(program, keys);
        update.kernel = read_file(folder.kernel());
        const box::SecretKey secret = secret_key(keys);
        parts.header = box::header_of(update, &secret);
        parts.certificates = certificates(keys);
        write_file(folder.update(), parts.header + update.kernel);
    }
    const bench::WorkFolder work("tappet-disk");
    write_disk(folder.disk(), parts, work / "");
}

/// Returns the lines that the box's init reads, from the firmware and the request.
std::string lines_of(const Request& request) {
    if (!fs::exists(request.kernel / "vmlinuz"))
        throw Fault("there is no kernel for a box at " + request.kernel.string() +
                    "; run ci/setup once as root");
    if (!fs::exists(request.firmware))
        throw Fault("there is no firmware at " + request.firmware.string() + "; build it first");
    const bench::Architecture& architecture = bench::architecture_of_first({request.firmware});
    if (!architecture.suffix.empty())
        throw Fault(request.firmware.string() + " is for " + architecture.name +
                    ", for which no image is written; start it on a system of the box's own");
    std::string lines = run_tool({fs::absolute(request.firmware).string(), "--board"});
    const box::Facts facts{lines};
    if (facts.one("board").empty())
        throw Fault(request.firmware.string() +
                    " does not name its board; it is not a firmware of Tappet, or an old one");
    if (facts.all("console").empty())
        throw Fault("board \"" + facts.one("board") +
                    "\" has no image settings; add .image with modules and consoles");
    lines += "image " + std::to_string(request.version) + "\n";
    if (!request.keys.empty())
        lines += "key " + public_key(request.next_keys.empty() ? request.keys : request.next_keys) + "\n";
    if (!request.plant.empty()) lines += "plant /bin/plant " + request.plant_words + "\n";
    return lines;
}

void write_root(const Request& request, const std::string& lines, const KernelModules& modules,
                const fs::path& data, const fs::path& archive) {
    bench::Initramfs root{archive, bench::architecture_of_first({request.firmware})};
    root.add(request.init, "/init");
    root.add(request.firmware, "/bin/firmware");
    if (!request.plant.empty()) root.add(request.plant, "/bin/plant");
    root.add("/sbin/e2fsck.static", "/bin/e2fsck");
    root.add_text("/etc/tappet/box", lines);
    root.add_text("/etc/tappet/modules", modules.table);
    root.add_text(box::empty_data_file, box::numbered_blocks(read_file(data)));
    for (const auto& [name, file] : modules.files) root.add(file, "/modules/" + name + ".ko");
    for (const char* folder : {"/proc", "/sys", "/tmp", "/run"}) root.add_folder(folder);
    root.finish();
}

} // namespace

void sign(const fs::path& folder, const fs::path& keys) {
    if (!can_sign(keys))
        throw Fault(keys.string() + " has no secret key; name the folder that tappet-image key wrote");
    finish(Folder{folder}, keys);
}

Written write_image(const Request& request) {
    const std::string lines = lines_of(request);
    const box::Facts facts{lines};
    const auto rows = [&](const char* word) {
        std::vector<std::string> all;
        for (const box::Words& row : facts.all(word)) all.push_back(joined(row));
        return all;
    };
    const std::string release = first_line(read_file(request.kernel / "release"));
    const std::string bill = bill_of(request, facts, release);
    const KernelModules modules =
        choose_modules(rows("module"), rows("later-module"), request.kernel / "lib/modules" / release);

    const bench::WorkFolder work("tappet-image");
    fs::create_directories(request.folder);
    write_data(work / "data");
    write_root(request, lines, modules, work / "data", work / "root.cpio");

    Written written;
    written.bill = request.folder / "sbom.cdx.json";
    write_file(written.bill, bill);
    const Folder folder{request.folder};
    written.disk = folder.disk();
    written.kernel = folder.kernel();
    written.root = request.folder / "root.cpio.zst";
    written.command_line = command_line_of(facts);
    run_tool({"zstd", "-q", "-f", "-19", "--no-progress", (work / "root.cpio").string(), "-o",
              written.root.string()});
    run_tool({"bg_gen_unified_kernel", std::string{boot_guard} + "kernel-stubx64.efi",
              (request.kernel / "vmlinuz").string(), written.kernel.string(), "--cmdline",
              written.command_line, "--initrd", written.root.string()});
    std::string unified = read_file(written.kernel);
    draw_together(unified);
    write_file(written.kernel, unified);
    write_file(folder.loader(), read_file(std::string{boot_guard} + "efibootguardx64.efi"));
    const box::Manifest manifest{facts.one("machine"), facts.one("board"), facts.one("layout"),
                                 request.version, request.least};
    write_file(folder.header(), box::header_of({manifest, read_file(written.kernel), {}}, nullptr) +
                                    "watchdog " + std::to_string(request.watchdog_s) + "\n");
    fs::remove(folder.update());
    const bool is_signed = can_sign(request.keys);
    finish(folder, is_signed ? request.keys : fs::path{});
    if (is_signed) written.update = folder.update();
    written.kernel_bytes = fs::file_size(request.kernel / "vmlinuz");
    written.root_bytes = fs::file_size(written.root);
    written.slot_bytes = fs::file_size(written.kernel);
    written.modules = modules.files.size();
    return written;
}

} // namespace tappet::image
