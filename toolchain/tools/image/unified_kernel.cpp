// SPDX-License-Identifier: Apache-2.0
// Edits addresses in the section table of a portable executable.
#include "toolchain/tools/image/unified_kernel.hpp"

#include "toolchain/tools/image/tool.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace tappet::image {

namespace {

// Offsets and sizes of the format.
constexpr std::size_t at_header = 0x3c, section_count = 6, optional_bytes = 20, optional_header = 24,
                      section_alignment = 32, image_bytes = 56, section_row = 40, name_bytes = 8,
                      virtual_bytes = 8, virtual_address = 12;

class Executable {
public:
    explicit Executable(std::string& bytes) : bytes_{bytes} {}

    [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t size = 4) const {
        if (at + size > bytes_.size()) throw Fault("the unified kernel image is cut off");
        std::uint32_t value = 0;
        std::memcpy(&value, bytes_.data() + at, size);
        return value;
    }
    void set(std::size_t at, std::uint32_t value) {
        static_cast<void>(number(at));
        std::memcpy(bytes_.data() + at, &value, sizeof value);
    }
    [[nodiscard]] std::string_view text(std::size_t at, std::size_t size) const {
        return std::string_view{bytes_}.substr(std::min(at, bytes_.size()), size);
    }

private:
    std::string& bytes_;
};

} // namespace

void draw_together(std::string& unified) {
    Executable image{unified};
    const std::size_t header = image.number(at_header), optional = header + optional_header,
                      rows = optional + image.number(header + optional_bytes, 2);
    if (image.text(header, 4) != std::string_view{"PE\0\0", 4})
        throw Fault("the unified kernel image is not a portable executable");
    const std::uint32_t alignment = image.number(optional + section_alignment);
    if (alignment == 0) throw Fault("the unified kernel image has no alignment of its sections");
    const auto aligned = [&](std::uint32_t address) {
        return (address + alignment - 1) / alignment * alignment;
    };
    std::uint32_t end = 0;
    for (std::size_t i = 0; i < image.number(header + section_count, 2); ++i) {
        const std::size_t row = rows + i * section_row;
        const std::string_view name = image.text(row, name_bytes);
        // The stub finds these two by their row; the other sections depend on their address.
        if (name.starts_with(".kernel") || name.starts_with(".initrd"))
            image.set(row + virtual_address, aligned(end));
        end = std::max(end, image.number(row + virtual_address) + image.number(row + virtual_bytes));
    }
    image.set(optional + image_bytes, aligned(end));
}

} // namespace tappet::image
