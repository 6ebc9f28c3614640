// SPDX-License-Identifier: Apache-2.0
// tappet-image: builds an image for a box from a firmware; flashes it; renews a slot.
#include "toolchain/tools/bench/folders.hpp"
#include "toolchain/tools/image/flash.hpp"
#include "toolchain/tools/image/image.hpp"
#include "toolchain/tools/image/keys.hpp"
#include "toolchain/tools/image/options.hpp"
#include "toolchain/tools/image/remote.hpp"
#include "toolchain/tools/image/slots.hpp"
#include "toolchain/version.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

namespace tappet::image {
namespace {

constexpr std::array write_options{
    Option{"--firmware", "FILE", "firmware of one machine for one board, stripped"},
    Option{"--to", "DIR", "where disk.img, tappet.efi and their parts go"},
    Option{"--plant", "FILE",
           "for a test board: the plant at the other end of the wires; when it ends, the box ends"},
    Option{"--plant-options", "TEXT", "options of the plant, as one argument"},
    Option{"--init", "FILE", "PID 1 (default: box-init beside this program)"},
    Option{.name = "--least",
           .value = "N",
           .help = "oldest version that accepts this as an update (default 1)",
           .is_number = true,
           .least = 1,
           .most = 4'000'000'000},
    image_options[0],
    image_options[1],
    image_options[2],
    image_options[3]};
constexpr std::array key_options{Option{"--to", "DIR", "where public and secret go"}};
constexpr std::array sign_options{Option{"--key", "DIR", "of tappet-image key, with what is secret"}};
constexpr std::array install_options{Option{"--kernel", "FILE", "a tappet.efi"}};
constexpr std::span<const Option> no_options{};

constexpr double goal_mb = 12.0;

int fail(const std::string& why) {
    std::fprintf(stderr, "tappet-image: %s\n", why.c_str());
    return 2;
}

int write(const CommandLine& line) {
    if (!line.has("--firmware") || !line.has("--to"))
        return fail("say write --firmware FILE --to DIR; see --help");
    Request request;
    request.firmware = line.text("--firmware");
    request.folder = line.text("--to");
    request.plant = line.text("--plant");
    request.plant_words = line.text("--plant-options");
    const auto own = std::filesystem::canonical("/proc/self/exe").parent_path() / "box-init";
    request.init = line.text("--init", own.native());
    request.kernel = bench::cache_folder() / "kernel/box";
    request.version = static_cast<std::uint32_t>(line.number("--version", 1));
    request.watchdog_s = static_cast<std::uint16_t>(line.number("--watchdog", 30));
    request.keys = line.text("--key");
    request.next_keys = line.text("--next-key");
    if (request.keys.empty() && !request.next_keys.empty())
        return fail("--next-key without --key: the box could not know who hands it over");
    request.least = static_cast<std::uint32_t>(line.number("--least", 1));
    const Written written = write_image(request);
    const auto mb = [](std::uint64_t bytes) { return static_cast<double>(bytes) * 1e-6; };
    std::printf("%s\n  a slot takes %.1f MB (goal %.0f: %s): kernel %.1f MB, root %.1f MB with %zu modules\n",
                written.disk.c_str(), mb(written.slot_bytes), goal_mb,
                mb(written.slot_bytes) <= goal_mb ? "held" : "MISSED", mb(written.kernel_bytes),
                mb(written.root_bytes), written.modules);
    std::printf("  command line: %s\n  what is inside: %s\n", written.command_line.c_str(),
                written.bill.c_str());
    if (!written.update.empty())
        std::printf("  signed; as an update, for the network or a stick: %s\n", written.update.c_str());
    else if (!request.keys.empty())
        std::printf("  NOT SIGNED: %s has no secret key; where it is, say tappet-image sign --key DIR %s\n",
                    request.keys.c_str(), request.folder.c_str());
    return 0;
}

/// Prints progress by tenths.
class Tenths {
public:
    void operator()(std::uint64_t bytes, std::uint64_t of) {
        const std::uint64_t tenth = 10 * bytes / of;
        if (tenth == told_) return;
        told_ = tenth;
        std::printf("%s%llu0 %%", told_ > 1 ? ", " : "", static_cast<unsigned long long>(told_));
        std::fflush(stdout);
    }

private:
    std::uint64_t told_ = 0;
};

int flash(const CommandLine& line) {
    if (!line.has("--image") || line.words.size() != 1)
        return fail("say flash --image disk.img DEVICE; lsblk lists the disks");
    const std::filesystem::path image = line.text("--image"), device = line.words[0];
    if (const std::string refusal = refusal_to_flash(image, device, line.has("--erase")); !refusal.empty())
        return fail(refusal);
    image::flash(image, device, Tenths{});
    std::printf("\n%s holds the image: written, and read back from it\n", device.c_str());
    return 0;
}

int make_keys(const CommandLine& line) {
    if (!line.has("--to")) return fail("say key --to DIR, a folder that stays with who makes the images");
    write_keys(line.text("--to"));
    std::printf(
        "%s: secret and *.key sign and leave this machine for nobody; public goes into images, and the "
        "*.cer\n  into the box's setup (Secure Boot: db, then KEK, then PK)\n",
        std::string{line.text("--to")}.c_str());
    return 0;
}

int sign(const CommandLine& line) {
    if (!line.has("--key") || line.words.size() != 1)
        return fail("usage: sign --key DIR FOLDER; FOLDER is the one that write --to named");
    const std::filesystem::path folder = line.words[0];
    image::sign(folder, line.text("--key"));
    std::printf("%s: loader, kernel, disk and update are signed\n", folder.c_str());
    return 0;
}

int show(const Answer& answer) {
    std::printf("%s", answer.text.c_str());
    return answer.is_accepted ? 0 : 1;
}

int update(const CommandLine& line) {
    if (line.words.size() != 2) return fail("usage: update BOX update.tap; BOX is its address");
    const Answer answer = send_update(std::string{line.words[0]}, line.words[1], Tenths{});
    std::printf("\n%s", answer.is_accepted ? "" : "the box refuses it: ");
    return show(answer);
}

int box(const CommandLine& line) {
    if (line.words.empty() || line.words.size() > 2)
        return fail("usage: box BOX, or box BOX roll-back --key DIR; BOX is its address");
    const std::string address{line.words[0]};
    if (line.words.size() == 1) return show(ask_status(address));
    if (std::ranges::find(box::order_verbs, line.words[1]) == box::order_verbs.end())
        return fail("\"" + std::string{line.words[1]} + "\" is not an order" +
                    did_you_mean(line.words[1], box::order_verbs,
                                 "; there are roll-back, factory-reset and measure"));
    if (!line.has("--key")) return fail("an order must be signed: add --key DIR");
    return show(send_order(address, std::string{line.words[1]}, secret_key(line.text("--key"))));
}

int install(const CommandLine& line) {
    if (!line.has("--kernel") || line.words.size() != 1)
        return fail("usage: install --kernel tappet.efi DISK; DISK is a box's disk, or its image");
    const std::uint32_t revision =
        image::install(std::filesystem::path{line.words[0]}, line.text("--kernel"));
    std::printf("revision %u goes on trial at the next boot\n", revision);
    return 0;
}

struct Word {
    std::string_view name;
    std::span<const Option> options;
    int (*run)(const CommandLine&);
    const char* usage;
};
constexpr std::array words_known{
    Word{"write", write_options, &write, "write --firmware FILE --to DIR: a disk image for a box"},
    Word{"flash", flash_options, &flash,
         "flash --image FILE [--erase] DEVICE: writes an image onto a disk, and reads it back"},
    Word{"install", install_options, &install,
         "install --kernel FILE DISK: writes a new version into the unused slot, for one trial"},
    Word{"key", key_options, &make_keys, "key --to DIR: makes new keys, for updates and for Secure Boot"},
    Word{"sign", sign_options, &sign,
         "sign --key DIR FOLDER: signs what write left unsigned, on a machine without a network"},
    Word{"update", no_options, &update,
         "update BOX update.tap: sends an update to a box; a person there must consent"},
    Word{"box", box_options, &box,
         "box BOX [roll-back | factory-reset | measure --key DIR]: shows what runs there, or sends an order "
         "that waits for consent"}};

int main(int count, char** words) {
    if (prints_version(count, words, "tappet-image")) return 0;
    const std::vector<std::string_view> all(words + 1, words + count);
    if (all.empty() || all[0] == "--help") {
        for (const Word& each : words_known)
            std::printf("tappet-image %s\n%s", each.usage, usage_of(each.options).c_str());
        return all.empty() ? 2 : 0;
    }
    const auto word = std::ranges::find(words_known, all[0], &Word::name);
    if (word == words_known.end())
        return fail("\"" + std::string{all[0]} +
                    "\" is not a command; there are write, flash, install, key, sign, update and box");
    const auto line = read_command_line(word->options, std::span{all}.subspan(1), Others::words);
    if (!line) return fail(line.error());
    try {
        return word->run(*line);
    } catch (const std::exception& fault) {
        return fail(fault.what());
    }
}

} // namespace
} // namespace tappet::image

int main(int count, char** words) { return tappet::image::main(count, words); }
