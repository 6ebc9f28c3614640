// Builds a running machine: constructs components at their planned places, wires them as the rows say, and
// configures them. MachineInstance::configure() uses it, and it is gone afterwards.
#pragma once

#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/map/layout.hpp"

#include <memory>

namespace tappet {

/// Used before arming, on one thread; not real-time.
class MachineBuilder {
public:
    MachineBuilder(MachineInstance& instance, const PropertyStore& store) noexcept
        : instance_{instance}, machine_{instance.machine()}, store_{store} {}

    /// Builds the machine. The error is the first component's refusal.
    std::expected<void, Sentence> build(std::span<const ProvidedDevice> devices);

private:
    /// Constructs objects with their default values.
    template <class T>
    std::span<T> make(const PlacesOf<T>& places) {
        const std::span<T> made = instance_.at(places);
        std::uninitialized_value_construct_n(made.data(), made.size());
        return made;
    }
    [[nodiscard]] std::expected<void, Sentence> share_memory();
    void construct();
    [[nodiscard]] Sentence configure_properties(std::size_t component);
    [[nodiscard]] static Sentence check_wake(const ComponentRow& row, const Setup& setup);
    void place_engines();
    void place_scope();
    void connect_clocks();
    void look_up(const void* member, const MemberKind& kind) noexcept;
    [[nodiscard]] Sentence describe_unlisted() const;
    [[nodiscard]] Sentence place_among_members(std::size_t c, const std::byte* address) const;

    [[nodiscard]] Sentence check_constants() const;
    void connect_data();
    void connect_row(std::size_t row);
    void add_waker(std::size_t row);
    [[nodiscard]] bool is_cause(std::size_t row) const;
    [[nodiscard]] bool hears_causes(std::size_t activity) const;
    void connect_extras();
    [[nodiscard]] bool has_initial(std::size_t connection) const noexcept;
    [[nodiscard]] bool is_in_circle(const Link& input) const;
    void place_needed_inputs();
    [[nodiscard]] LifeSign life_sign_of(std::string_view watched) noexcept;

    void connect_events();
    void place_lanes(std::size_t subscription, AsyncReaction& reaction);
    void bind_receiver(std::size_t subscription, AsyncReaction& reaction);
    void place_mailboxes();
    template <class Box>
    std::span<Box> make_mailboxes(const PlacesOf<Box>& places, std::span<const MailPlan> mail,
                                  const MailPlan& requests, std::size_t receiver);
    void connect_operations();

    [[nodiscard]] Sentence place_behaviours();
    [[nodiscard]] Sentence connect_controls();
    [[nodiscard]] Sentence place_unit(std::size_t row, Behaviour& behaviour);
    void place_slot(std::size_t row, Behaviour& behaviour);

    void place_map();
    void place_facet(End end, map::Facet& record);
    void place_figure(map::Figure& figure);
    void place_fields(const map::Header& header);
    [[nodiscard]] std::uint64_t offset_of(const void* place) const noexcept;

    MachineInstance& instance_;
    const AcceptedMachine& machine_;
    const PropertyStore& store_;
    std::size_t constructed_ = 0; ///< the component that is constructed now
    /// The first facet member that no interface() lists; without a kind: there is none.
    struct {
        std::size_t component = nowhere;
        const std::byte* member = nullptr;
        const MemberKind* kind = nullptr;
    } unlisted_;
};

} // namespace tappet
