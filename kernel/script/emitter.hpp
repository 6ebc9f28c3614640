// The output of the script compiler: rows in the room, and the layout of each type's data.
#pragma once

#include "kernel/script/reader.hpp"

namespace tappet::script_detail {

/// While a type is compiled its values have places within one of four regions; when it is complete the
/// regions are concatenated and the places become offsets.
enum class Region : std::uint8_t { constants, variables, arguments, scratch };
inline constexpr unsigned region_bits = 14;
inline constexpr std::uint32_t region_bytes = (1u << region_bits) - 16;

constexpr Region region_of(DataOffset place) noexcept { return static_cast<Region>(place >> region_bits); }
constexpr std::uint32_t within(DataOffset place) noexcept { return place & ((1u << region_bits) - 1); }
constexpr DataOffset moved(DataOffset place, std::size_t by) noexcept {
    return static_cast<DataOffset>(place + by);
}
constexpr std::uint32_t aligned(std::size_t bytes, std::uint32_t to = 8) noexcept {
    return (static_cast<std::uint32_t>(bytes) + to - 1) / to * to;
}

/// Rows of one kind: those of earlier types, then those of the current type.
template <class Row>
struct Rows {
    std::span<Row> room{};
    std::uint32_t used = 0;
    std::uint32_t base = 0;

    [[nodiscard]] constexpr std::uint32_t count() const noexcept { return used - base; }
    constexpr Row& operator[](std::size_t i) const noexcept { return room[base + i]; }
    [[nodiscard]] constexpr std::span<Row> view() const noexcept { return room.subspan(base, used - base); }
};

class Emitter {
public:
    constexpr Emitter(Reader& text, const ScriptRoom& room) : text_{text} {
        for_each_table([](auto& span, auto& rows) { rows.room = span; }, room, *this);
    }

    Rows<Instruction> instructions{};
    Rows<ConditionRow> conditions{};
    Rows<NodeRow> nodes{};
    Rows<ArcRow> arcs{};
    Rows<ProgramRow> programs{};
    Rows<VariableRow> variables{};
    Rows<LinkRow> links{};
    Rows<std::byte> image{}; ///< `used`: up to the last complete type or instance
    Rows<StateRow> states{};
    Rows<TransitionRow> transitions{};
    Rows<CaptureRow> captures{};
    Rows<BehaviourType> types{};         ///< of the whole script
    Rows<BehaviourInstance> instances{}; ///< of the whole script
    Rows<char> names{};
    Rows<Reachable> reach{};

    // ---- rows

    template <class Row>
    constexpr std::uint16_t add(Rows<Row>& rows, const Row& row, std::string_view what) {
        if (rows.used == rows.room.size() || rows.count() >= 0xfff0) {
            text_.fail_room(what);
            return 0;
        }
        rows.room[rows.used++] = row;
        return static_cast<std::uint16_t>(rows.count() - 1);
    }
    constexpr void emit(const Instruction& instruction) {
        if (text_.ok()) add(instructions, instruction, "instructions");
    }
    /// Emits the instruction with a new place in the scratch as its `to`, and returns that place.
    constexpr DataOffset emit_to_scratch(Instruction instruction, std::size_t size) {
        instruction.to = scratch(size);
        emit(instruction);
        return instruction.to;
    }
    [[nodiscard]] constexpr std::uint16_t instruction_count() const noexcept {
        return static_cast<std::uint16_t>(instructions.count());
    }
    constexpr Instruction& last_instruction() noexcept { return instructions[instructions.count() - 1]; }

    /// Copies characters so that they outlive the text.
    constexpr std::string_view keep(std::initializer_list<std::string_view> pieces) {
        const std::uint32_t from = names.used;
        for (const std::string_view piece : pieces) {
            if (names.room.size() - names.used < piece.size()) {
                text_.fail_room("characters of names");
                return {};
            }
            std::copy_n(piece.data(), piece.size(), names.room.data() + names.used);
            names.used += static_cast<std::uint32_t>(piece.size());
        }
        return {names.room.data() + from, names.used - from};
    }

    // ---- data

    constexpr DataOffset place_in(Region region, std::size_t size) {
        std::uint32_t& used = region_used_[static_cast<std::size_t>(region)];
        const std::uint32_t at = used;
        if (size > region_bytes || at + aligned(size) > region_bytes) {
            text_.fail_limit(region == Region::constants ? "constants" : "data");
            return 0;
        }
        used = at + aligned(size);
        if (region == Region::scratch) scratch_most_ = std::max(scratch_most_, used);
        return static_cast<DataOffset>(static_cast<std::uint32_t>(region) << region_bits | at);
    }
    constexpr DataOffset scratch(std::size_t size) { return place_in(Region::scratch, size); }
    /// The scratch is written before it is read within one node.
    constexpr void clear_scratch() noexcept { region_used_[static_cast<std::size_t>(Region::scratch)] = 0; }

    /// Allocates zero bytes for a constant; null: no room.
    constexpr std::byte* add_constant(std::size_t size, DataOffset& at) {
        at = place_in(Region::constants, size);
        return zeros(image.base + within(at), size, "constants");
    }
    [[nodiscard]] constexpr std::byte* constant_bytes(DataOffset at) const noexcept {
        return image.room.data() + image.base + within(at);
    }
    /// Adds a constant of at most 8 bytes, low byte first; equal constants share a place.
    constexpr DataOffset small_constant(std::uint64_t bits) {
        std::uint16_t& head = constant_heads_[(bits ^ (bits >> 32) ^ (bits >> 54)) % constant_heads_.size()];
        for (std::uint16_t i = head; i != 0; i = constants_[i - 1].next)
            if (constants_[i - 1].bits == bits) return constants_[i - 1].at;
        DataOffset at = 0;
        std::byte* const bytes = add_constant(8, at);
        if (bytes == nullptr) return 0;
        for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::byte>(bits >> (8 * i));
        if (constants_used_ < constants_.size()) {
            constants_[constants_used_++] = {bits, at, head};
            head = static_cast<std::uint16_t>(constants_used_);
        }
        return at;
    }
    /// Allocates initial bytes of a variable; they stay at the end of the room, the first variable last,
    /// until all constants are known. Null: no room.
    constexpr std::byte* add_variable(std::size_t size, DataOffset& at) {
        at = place_in(Region::variables, size);
        return zeros(image.room.size() - region_used(Region::variables), size, "variables");
    }
    /// Adds a variable of zero bytes; returns its place.
    constexpr DataOffset add_variable(std::string_view name, TypeId type, VariableKind kind) {
        DataOffset at = no_data;
        static_cast<void>(add_variable(type->size, at));
        add(variables, VariableRow{keep({name}), type, at, kind}, "variables");
        return at;
    }
    /// Allocates initial data of an instance, after those of all types. Empty: no room.
    constexpr std::span<std::byte> add_image(std::size_t size) {
        image.used = aligned(image.used, data_alignment);
        if (image.room.size() < image.used || image.room.size() - image.used < size) {
            text_.fail_room("bytes of initial data");
            return {};
        }
        image.used += static_cast<std::uint32_t>(size);
        return image.room.subspan(image.used - size, size);
    }

    // ---- a type: its rows begin after those of the earlier types

    constexpr void begin_type() {
        image.used = aligned(image.used, data_alignment);
        for_each_table([](auto& rows) { rows.base = rows.used; }, *this);
        types.base = instances.base = 0;
        region_used_ = {};
        scratch_most_ = 0;
        constant_heads_ = {};
        constants_used_ = 0;
    }
    /// Adds the type of the rows since begin_type(), and turns places into offsets. Null after a fault.
    constexpr BehaviourType* end_type(std::string_view name) {
        if (!text_.ok()) return nullptr;
        add(types, {.name = name}, "types");
        if (!text_.ok()) return nullptr;
        BehaviourType& type = types[types.used - 1];
        lay_out(type.tables);
        return text_.ok() ? &type : nullptr;
    }
    /// Sets the numbers of rows that are used.
    constexpr void count_rows(ScriptSizes& sizes) const {
        for_each_table([](const auto& rows, auto& size) { size = rows.used; }, *this, sizes);
        sizes.image = aligned(std::max(image_most_, image.used), data_alignment);
    }

private:
    [[nodiscard]] constexpr std::uint32_t region_used(Region region) const noexcept {
        return region_used_[static_cast<std::size_t>(region)];
    }
    constexpr std::byte* zeros(std::size_t offset, std::size_t size, std::string_view what) {
        const std::uint32_t constants_end = image.base + region_used(Region::constants);
        const std::uint32_t variables_size = region_used(Region::variables);
        if (constants_end + variables_size > image.room.size()) text_.fail_room(what);
        if (!text_.ok()) return nullptr;
        std::byte* const bytes = image.room.data() + offset;
        for (std::size_t i = 0; i < aligned(size); ++i) bytes[i] = std::byte{0};
        image_most_ = std::max(image_most_, constants_end + 2 * variables_size);
        return bytes;
    }
    constexpr void lay_out(ProgramTables& tables) {
        const std::uint32_t constants_end = aligned(region_used(Region::constants), data_alignment);
        const std::uint32_t variables_end =
            constants_end + aligned(region_used(Region::variables), data_alignment);
        const std::uint32_t arguments_end =
            variables_end + aligned(region_used(Region::arguments), data_alignment);
        const std::uint32_t size = arguments_end + aligned(scratch_most_, data_alignment);
        if (size > 0xff00) return text_.fail_limit("data");
        image_most_ = std::max(image_most_, image.base + constants_end + 2 * (variables_end - constants_end));
        if (image_most_ > image.room.size()) return text_.fail_room("bytes of initial data");
        for (const VariableRow& row : variables.view()) {
            if (region_of(row.at) != Region::variables) continue;
            const std::size_t at = within(row.at), bytes = aligned(row.type->size);
            std::copy_n(image.room.data() + image.room.size() - at - bytes, bytes,
                        image.room.data() + image.base + constants_end + at);
        }
        const std::uint32_t begin[] = {0, constants_end, variables_end, arguments_end};
        const auto put = [&begin](DataOffset& place) {
            if (place != no_data)
                place = moved(static_cast<DataOffset>(within(place)),
                              begin[static_cast<std::size_t>(region_of(place))]);
        };
        for (Instruction& in : instructions.view()) put(in.to), put(in.a), put(in.b);
        for (ConditionRow& row : conditions.view()) put(row.result);
        for (ArcRow& row : arcs.view()) put(row.after);
        for (VariableRow& row : variables.view()) put(row.at);
        for (CaptureRow& row : captures.view()) put(row.raw);
        image.used = image.base + variables_end;
        tables = {.instructions = instructions.view(),
                  .conditions = conditions.view(),
                  .nodes = nodes.view(),
                  .arcs = arcs.view(),
                  .programs = programs.view(),
                  .variables = variables.view(),
                  .links = links.view(),
                  .image = image.view(),
                  .layout = {static_cast<DataOffset>(constants_end), static_cast<DataOffset>(variables_end),
                             static_cast<DataOffset>(arguments_end), static_cast<DataOffset>(size)}};
    }

    struct SharedConstant {
        std::uint64_t bits = 0;
        DataOffset at = 0;
        std::uint16_t next = 0; // 1 + number in the list
    };

    Reader& text_;
    std::array<std::uint32_t, 4> region_used_{};
    std::uint32_t scratch_most_ = 0;
    std::uint32_t image_most_ = 0;
    std::array<SharedConstant, 256> constants_{};
    std::array<std::uint16_t, 128> constant_heads_{};
    std::size_t constants_used_ = 0;
};

} // namespace tappet::script_detail
