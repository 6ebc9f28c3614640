// The layout of the map that a machine holds at the beginning of its memory: every component, facet, row and
// type with the place of its live value. It is flat and uses offsets, so that another process can read it
// (thesis 4.7.2, 4.8).
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

/// One block of memory is shared, read-only for every process but the machine. It begins with Header; all
/// offsets (names ending in `_at`) count bytes from there, and 0 means: none. All integers are little-endian.
/// A section is an array of records; a reader steps by the section's stride, so that a later machine may
/// append members to a record. Any other change of the layout gets a new layout_version.
///
/// The map itself never changes once Header::ready is 1. Live values follow it. A component's value changes
/// only while the generation of its activity is odd: read the generation, copy, read it again; equal and even
/// means the copy is whole. Single words (forced flags, counters) need no generation.
namespace tappet::map {

inline constexpr std::array<char, 8> magic{'T', 'A', 'P', 'P', 'E', 'T', 'M', 'P'};
inline constexpr std::uint32_t layout_version = 5;
/// An index that refers to nothing.
inline constexpr std::uint32_t none = 0xffffffffu;

/// Characters in the map; not terminated.
struct Text {
    std::uint32_t at = 0;
    std::uint32_t length = 0;
};

struct Section {
    std::uint32_t at = 0;
    std::uint32_t count = 0;
    std::uint32_t stride = 0; ///< bytes from one record to the next
    std::uint32_t reserved = 0;
};

struct Header {
    std::array<char, 8> magic{};
    std::uint32_t layout_version = 0;
    std::uint32_t header_bytes = 0;
    std::uint64_t map_bytes = 0;   ///< header, sections and texts
    std::uint64_t block_bytes = 0; ///< everything that is shared
    std::uint64_t structure = 0;   ///< digest of the map as the compiler made it: equal for equal tables
    std::uint32_t ready = 0;       ///< 1 once every place is valid; written last
    std::int32_t process = 0;      ///< the machine's process
    Text machine;
    Text board;
    Text world;                      ///< "host", "bench" or "box"
    std::array<char, 48> build_id{}; ///< hexadecimal, of the linked binary; empty when it has none
    std::uint64_t forced_at = 0;     ///< uint32: how many ports are forced now
    Section components;
    Section facets; ///< in the order of their components
    Section activities;
    Section connections;
    Section reactions;
    Section behaviours;
    Section types;
    Section fields;
    Section enumerators;
    Section figures;
    Section texts; ///< its stride is 1
    /// scope::Directory of kernel/machine/plan/scope_layout.hpp: records of the machine's own cycles.
    std::uint64_t scope_at = 0;
    /// recorded::Directory of kernel/services/reporting/layout.hpp: records of the machine's values.
    std::uint64_t report_at = 0;
    std::array<char, 16> framework{}; ///< Tappet's version, as "0.15"
};

struct Component {
    Text name;
    Text type;   ///< the name of the C++ struct
    Text device; ///< the device it drives, by its logical name; empty for none
    std::uint32_t activity = none;
    std::uint32_t first_facet = 0;
    std::uint32_t facet_count = 0;
    std::uint32_t position = 0; ///< among the components of its activity: the order in which they run
    std::uint64_t place_at = 0;
    std::uint64_t bytes = 0;
};

/// Facet::flags.
enum FacetFlag : std::uint32_t {
    facet_required = 1,     ///< the table must connect it
    facet_any_thread = 2,   ///< an operation or method that runs in its caller's activity
    facet_has_range = 4,    ///< low and high are bounds
    facet_can_force = 8,    ///< a data port
    facet_is_shared = 16,   ///< an input or output of a connection between two activities
    facet_connected = 32,   ///< an input with a row
    facet_can_request = 64, ///< browsers may set, call or send it through the socket
    facet_for_people = 128, ///< its interface offers it to people; without it, nobody asks over the network
    facet_moves = 256,      ///< it moves something: nobody asks for it over the network
    facet_moves_while_held = 512 ///< it moves something while somebody holds it, at the panel
};

/// One facet of one component. Its full name is the component's, a dot, and `name` (which may hold dots).
struct Facet {
    Text name;
    Text unit;
    Text doc;
    Text kind; ///< "input", "output", "property", "event", "operation", "method", "command", ...
    std::uint32_t component = none;
    std::uint32_t type = none; ///< of the value, or of the argument list
    /// Type of a method's result; for a command, the list of its results.
    std::uint32_t result = none;
    std::uint32_t flags = 0;
    double low = 0; ///< of a property, both ends included
    double high = 0;
    std::uint64_t value_at = 0; ///< of ports and properties: the value as its component sees it
    std::uint64_t stamp_at = 0; ///< int64: the time at which the value was true, in ns
    /// uint64: the number of writes so far; 0: never written, and the value is the row's initial one.
    std::uint64_t writes_at = 0;
    std::uint64_t forced_at = 0;       ///< byte: 0, or 1 while the port is forced
    std::uint64_t forced_value_at = 0; ///< the value that it then has
    /// The lowest role that may set, call or send it: "operator", "engineer"; empty: no role can.
    Text role;
};

struct Activity {
    Text name;
    Text trigger; ///< "every", "on_work", "on_device", "background"
    std::int64_t period_ns = 0;
    std::int64_t deadline_ns = 0;
    std::int64_t budget_ns = 0;
    std::int64_t at_most_per_ns = 0;
    std::uint32_t at_most_n = 0;
    std::uint32_t real_time = 0;
    std::int32_t priority = 0;
    std::int32_t processor = 0;
    std::uint64_t generation_at = 0; ///< uint64: odd while one of its cycles runs
    std::uint64_t now_at = 0;        ///< int64: the time of its last cycle, in ns
};

/// Connection::flags.
enum ConnectionFlag : std::uint32_t {
    connection_buffered = 1,
    connection_across = 2, ///< between two activities
    connection_wakes = 4,
    connection_delayed = 8,
    connection_scaled = 16 ///< the reader gets a different number from the one written
};

struct Connection {
    std::uint32_t from = none; ///< facet
    std::uint32_t to = none;   ///< facet
    std::uint32_t flags = 0;
    std::uint32_t capacity = 0;  ///< of a buffer
    std::int64_t max_age_ns = 0; ///< 0: a value never becomes stale
    Text when_stale;             ///< "hold", "substitute", "stop"
    Text overflow;               ///< of a buffer: "reject", "drop_oldest"
    std::uint64_t times_at = 0;  ///< Times, of a row that wakes
};

struct Reaction {
    Text how;                       ///< "tell", "call", "trigger" (of a behaviour), "uses", ...
    std::uint32_t from = none;      ///< facet: the event, or the requester
    std::uint32_t to = none;        ///< facet: the operation; none for a trigger
    std::uint32_t behaviour = none; ///< of a trigger
    std::uint32_t quota = 0;        ///< unserved emissions that may wait
    std::uint32_t from_activity = none;
    std::uint32_t to_activity = none;
    std::uint64_t times_at = 0; ///< Times, of a "tell"
};

/// The latency of a row: from the stamp of the edge or frame that triggered it to the end of the action that
/// the row leads to, in the receiving activity; guarded by that activity's generation.
struct Times {
    std::uint64_t count = 0;
    std::int64_t total_ns = 0;
    std::int64_t longest_ns = 0;
    /// Counts by latency: the first entry counts those below 1 us, each further one covers twice the time of
    /// the one before it, the last also all beyond.
    std::array<std::uint32_t, 16> histogram{};
};

struct Behaviour {
    std::uint32_t component = none;
    std::uint32_t is_slot = 0; ///< reserved for a behaviour that is loaded later
    std::uint64_t bytes = 0;   ///< of the slot
    std::uint32_t states = 0;  ///< of a state machine
    std::uint32_t reserved = 0;
};

/// The form of a value. The numbers are part of the layout.
enum class Shape : std::uint8_t {
    opaque = 0,      ///< bytes that only the machine understands
    boolean = 1,     ///< bool
    integer = 2,     ///< signed integer of 1, 2, 4 or 8 bytes
    natural = 3,     ///< unsigned integer of 1, 2, 4 or 8 bytes
    real = 4,        ///< float or double
    duration = 5,    ///< int64, nanoseconds
    text = 6,        ///< characters at items_at, their number (unsigned, length_bytes wide) at length_at
    matrix = 7,      ///< rows * columns elements from items_at on
    record = 8,      ///< fields
    enumeration = 9, ///< an integer of 1, 2, 4 or 8 bytes with names
    sequence = 10,   ///< up to `columns` elements at items_at, their number at length_at
    arguments = 11   ///< fields without names: of an event, an operation, a method, a command
};

/// items_at and length_at count from the beginning of the value.
struct Type {
    Text name;
    Shape shape = Shape::opaque;
    std::uint8_t row_major = 0;
    std::uint8_t length_bytes = 0;
    std::uint8_t reserved = 0;
    std::uint32_t element = none; ///< type of a matrix' or a sequence's elements
    std::uint32_t rows = 0;
    std::uint32_t columns = 0; ///< of a matrix; for a text or a sequence: the capacity
    std::uint64_t size = 0;
    std::uint32_t first_field = 0;
    std::uint32_t field_count = 0;
    std::uint32_t first_enumerator = 0;
    std::uint32_t enumerator_count = 0;
    std::uint32_t items_at = 0;
    std::uint32_t length_at = 0;
};

struct Field {
    Text name;
    Text unit;
    std::uint32_t type = none;
    std::uint32_t at = 0; ///< from the beginning of the record; of arguments: packed without gaps
};

struct Enumerator {
    Text name;
    std::int64_t value = 0;
};

/// The owner of a figure; the numbers are part of the layout.
enum class Owner : std::uint32_t { machine = 0, component = 1, activity = 2, connection = 3, reaction = 4 };

/// A counter, a state or a time that the framework keeps for a part of the machine: cycles and missed
/// deadlines of an activity, the state of a component, losses of a row.
struct Figure {
    Owner owner = Owner::machine;
    std::uint32_t index = 0; ///< of the owner in its section
    Text name;
    Text unit;
    Text doc;
    std::uint32_t type = none;
    std::uint32_t activity = none; ///< whose generation guards it; none: a single atomic word
    std::uint64_t value_at = 0;
};

template <class Record>
inline constexpr bool is_plain =
    std::is_trivially_copyable_v<Record> && std::is_standard_layout_v<Record> && alignof(Record) <= 8;
static_assert(is_plain<Header> && is_plain<Component> && is_plain<Facet> && is_plain<Activity> &&
              is_plain<Connection> && is_plain<Reaction> && is_plain<Times> && is_plain<Behaviour> &&
              is_plain<Type> && is_plain<Field> && is_plain<Enumerator> && is_plain<Figure>);
static_assert(sizeof(Header) == 336 && sizeof(Component) == 56 && sizeof(Facet) == 112 &&
                  sizeof(Activity) == 80 && sizeof(Connection) == 48 && sizeof(Reaction) == 40 &&
                  sizeof(Times) == 88 && sizeof(Behaviour) == 24 && sizeof(Type) == 56 &&
                  sizeof(Field) == 24 && sizeof(Enumerator) == 16 && sizeof(Figure) == 48,
              "the layout changed: give it a new layout_version");

} // namespace tappet::map
