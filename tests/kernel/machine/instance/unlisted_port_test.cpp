// A port, or another member that is a facet, that interface() does not list: nothing can connect it, so a
// machine with it does not start.
#include "tests/kernel/machine/virtual_rig.hpp"

namespace tappet {
namespace {

/// Forgets, as its template arguments say, a port in its interface().
template <bool forgets_first, bool forgets_last>
struct Press {
    Output<double> force;
    Input<double> wanted;
    int strokes = 0;
    Output<bool> lamp;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        force.write(wanted.get());
        lamp.write(true);
    }
    static constexpr auto interface() {
        constexpr auto middle = input<&Press::wanted>("wanted", "N", "force that it shall have", optional);
        if constexpr (forgets_first)
            return facets(middle, output<&Press::lamp>("lamp", "", "that shines"));
        else if constexpr (forgets_last)
            return facets(output<&Press::force>("force", "N", "that it presses with"), middle);
        else
            return facets(output<&Press::force>("force", "N", "that it presses with"), middle,
                          output<&Press::lamp>("lamp", "", "that shines"));
    }
};
/// Forgets its only port.
struct Alone {
    Output<double> force;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(); }
};

template <class T>
std::string refusal_of() {
    static constexpr auto table =
        machine("unlisted", components(component<T>("press")),
                activities(activity("motion", every(1ms), budget(10us), runs("press"))), connections(),
                reactions(), behaviours());
    PlacedRig<table> rig;
    const auto configured = rig.instance.configure({});
    return configured ? std::string{} : std::string{configured.error().view()};
}

TEST(UnlistedPort, does_not_exist_where_the_interface_lists_all) {
    EXPECT_EQ((refusal_of<Press<false, false>>()), "");
}
TEST(UnlistedPort, is_found_between_listed_members) {
    EXPECT_NE((refusal_of<Press<true, false>>().find("component \"press\": its type ")), std::string::npos);
    EXPECT_NE((refusal_of<Press<true, false>>().find(
                  " has a port before \"wanted\" that interface() does not list, so that no row can "
                  "connect it; list it, input<..> or output<..>, or remove it")),
              std::string::npos)
        << refusal_of<Press<true, false>>();
    EXPECT_NE((refusal_of<Press<false, true>>().find(" has a port behind \"wanted\" that ")),
              std::string::npos);
}
TEST(UnlistedPort, is_found_in_a_component_without_facets) {
    EXPECT_NE(refusal_of<Alone>().find("Alone has a port that interface() does not list"), std::string::npos)
        << refusal_of<Alone>();
}

/// Forgets one member of that type.
template <class Member>
struct Forgetful {
    Member forgotten;
    Property<double> kept{1.0};
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(property<&Forgetful::kept>("kept", "", "listed")); }
};
template <class Member>
void expect_refused(std::string_view said) {
    const std::string refusal = refusal_of<Forgetful<Member>>();
    EXPECT_NE(refusal.find(Sentence{" has ", said}.view()), std::string::npos) << refusal;
}

TEST(UnlistedMember, of_each_kind_is_found) {
    expect_refused<Event<>>(
        "an event before \"kept\" that interface() does not list, so that nobody can hear it; "
        "list it, event<..>, or remove it");
    expect_refused<Property<bool>>(
        "a property before \"kept\" that interface() does not list, so that no row, "
        "file or person can set it; list it, property<..>, or remove it");
    expect_refused<Timer>(
        "a timer before \"kept\" that interface() does not list, so that it never fires; list "
        "it, timer<..>, or remove it");
    expect_refused<MethodCall<bool(int)>>(
        "a method call before \"kept\" that interface() does not list, so that "
        "no row can say what it calls; list it, calls<..>, or remove it");
    expect_refused<CommandCall<double>>(
        "a command call before \"kept\" that interface() does not list, so that "
        "no row can say what it sends; list it, sends<..>, or remove it");
    expect_refused<EventHandle>(
        "an event handle before \"kept\" that interface() does not list, so that no row "
        "can be connected by it; list it, handle<..>, or remove it");
    expect_refused<EventWait<>>(
        "an event wait before \"kept\" that interface() does not list, so that no row can "
        "say what it waits for; list it, awaits<..>, or remove it");
    expect_refused<BufferInput<int>>("a port before \"kept\" that ");
    expect_refused<BufferOutput<int>>("a port before \"kept\" that ");
}
TEST(UnlistedMember, does_not_exist_of_a_handle_that_is_a_copy) {
    EXPECT_EQ(refusal_of<Forgetful<ScopedEventHandle>>(), "");
}
TEST(UnlistedMember, is_found_within_an_array) {
    expect_refused<std::array<Event<>, 2>>("an event before \"kept\" that ");
}

} // namespace
} // namespace tappet
