// The layout of kernel/machine/map/layout.hpp written by hand, and a server of one thread.
#include "tests/toolchain/tools/browser/sample_machine.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace tappet::browser {

namespace {

constexpr std::uint64_t values_at = 64 * 1024; ///< behind the largest map of any test

} // namespace

SampleMap::SampleMap() : end_{values_at} {
    header_.magic = map::magic;
    header_.layout_version = map::layout_version;
    header_.header_bytes = sizeof(map::Header);
    header_.ready = 1;
    header_.process = 4711;
    header_.machine = text("sample");
    header_.board = text("test");
    header_.world = text("host");
    header_.forced_at = take(8);
    f64 = type("double", map::Shape::real, 8);
    i32 = type("int32", map::Shape::integer, 4);
    u8 = type("uint8", map::Shape::natural, 1);
    boolean = type("bool", map::Shape::boolean, 1);
    duration = type("Duration", map::Shape::duration, 8);
}

map::Text SampleMap::text(std::string_view text) {
    const map::Text place{static_cast<std::uint32_t>(sizeof(map::Header) + texts_.size()),
                          static_cast<std::uint32_t>(text.size())};
    texts_ += text;
    return place;
}

std::uint64_t SampleMap::take(std::uint64_t bytes) {
    const std::uint64_t at = end_;
    end_ += (bytes + 7) / 8 * 8;
    return at;
}

std::uint32_t SampleMap::activity(std::string_view name) {
    map::Activity each;
    each.name = text(name);
    each.trigger = text("every");
    each.period_ns = 1'000'000;
    each.deadline_ns = 1'000'000;
    each.budget_ns = 60'000;
    each.real_time = 1;
    each.generation_at = take(8);
    each.now_at = take(8);
    activities_.push_back(each);
    return static_cast<std::uint32_t>(activities_.size() - 1);
}

std::uint32_t SampleMap::component(std::string_view name, std::string_view type, std::uint32_t activity,
                                   std::string_view device) {
    map::Component each;
    each.name = text(name);
    each.type = text(type);
    each.device = text(device);
    each.activity = activity;
    each.first_facet = static_cast<std::uint32_t>(facets_.size());
    components_.push_back(each);
    return static_cast<std::uint32_t>(components_.size() - 1);
}

std::uint32_t SampleMap::facet(std::string_view name, std::string_view kind, std::uint32_t type,
                               std::string_view unit, std::string_view doc, std::uint32_t flags) {
    map::Facet each;
    each.name = text(name);
    each.kind = text(kind);
    each.unit = text(unit);
    each.doc = text(doc);
    each.type = type;
    each.flags = flags;
    each.role = text(kind == "command" ? "operator" : kind == "property" ? "engineer" : "");
    each.component = static_cast<std::uint32_t>(components_.size() - 1);
    if (kind == "input" || kind == "output" || kind == "property") each.value_at = take(types_[type].size);
    if (kind == "input" || kind == "output") {
        each.stamp_at = take(8);
        each.writes_at = take(8);
    }
    if ((flags & map::facet_can_force) != 0) {
        each.forced_at = take(1);
        each.forced_value_at = take(types_[type].size);
    }
    ++components_.back().facet_count;
    facets_.push_back(each);
    return static_cast<std::uint32_t>(facets_.size() - 1);
}

std::uint32_t SampleMap::type(std::string_view name, map::Shape shape, std::uint64_t size) {
    map::Type each;
    each.name = text(name);
    each.shape = shape;
    each.size = size;
    types_.push_back(each);
    return static_cast<std::uint32_t>(types_.size() - 1);
}

std::uint32_t SampleMap::enumeration(std::string_view name, std::uint64_t size,
                                     const std::vector<std::pair<std::string_view, std::int64_t>>& names) {
    const std::uint32_t index = type(name, map::Shape::enumeration, size);
    types_[index].first_enumerator = static_cast<std::uint32_t>(enumerators_.size());
    types_[index].enumerator_count = static_cast<std::uint32_t>(names.size());
    for (const auto& [word, value] : names) enumerators_.push_back({text(word), value});
    return index;
}

std::uint32_t SampleMap::record(std::string_view name,
                                const std::vector<std::pair<std::string_view, std::uint32_t>>& fields,
                                map::Shape shape) {
    const std::uint32_t index = type(name, shape, 0);
    types_[index].first_field = static_cast<std::uint32_t>(fields_.size());
    types_[index].field_count = static_cast<std::uint32_t>(fields.size());
    for (const auto& [word, field_type] : fields) {
        fields_.push_back({text(word), {}, field_type, static_cast<std::uint32_t>(types_[index].size)});
        types_[index].size += types_[field_type].size;
    }
    return index;
}

std::uint32_t SampleMap::matrix(std::uint32_t element, std::uint32_t rows, std::uint32_t columns,
                                bool row_major) {
    const std::uint32_t index = type("matrix", map::Shape::matrix, types_[element].size * rows * columns);
    types_[index].element = element;
    types_[index].rows = rows;
    types_[index].columns = columns;
    types_[index].row_major = row_major ? 1 : 0;
    return index;
}

std::uint32_t SampleMap::text_type(std::uint32_t capacity) {
    const std::uint32_t index = type("text", map::Shape::text, capacity + 4);
    types_[index].columns = capacity;
    types_[index].items_at = 4;
    types_[index].length_bytes = 4;
    return index;
}

std::uint32_t SampleMap::sequence(std::uint32_t element, std::uint32_t capacity) {
    const std::uint32_t index = type("sequence", map::Shape::sequence, 8 + types_[element].size * capacity);
    types_[index].element = element;
    types_[index].columns = capacity;
    types_[index].items_at = 8;
    types_[index].length_bytes = 8;
    return index;
}

void SampleMap::connect(std::uint32_t from, std::uint32_t to, std::int64_t max_age_ns) {
    map::Connection each;
    each.from = from;
    each.to = to;
    each.max_age_ns = max_age_ns;
    each.when_stale = text("hold");
    connections_.push_back(each);
}

void SampleMap::react(std::string_view how, std::uint32_t from, std::uint32_t to) {
    map::Reaction each;
    each.how = text(how);
    each.from = from;
    each.to = to;
    reactions_.push_back(each);
}

void SampleMap::figure(map::Owner owner, std::uint32_t index, std::string_view name, std::uint32_t type) {
    map::Figure each;
    each.owner = owner;
    each.index = index;
    each.name = text(name);
    each.type = type;
    each.value_at = take(types_[type].size);
    figures_.push_back(each);
}

template <class Record>
map::Section SampleMap::lay(std::vector<std::byte>& block, const std::vector<Record>& records) {
    map::Section section;
    section.at = static_cast<std::uint32_t>((header_.map_bytes + 7) / 8 * 8);
    section.count = static_cast<std::uint32_t>(records.size());
    section.stride = sizeof(Record);
    if (!records.empty())
        std::memcpy(block.data() + section.at, records.data(), records.size() * sizeof(Record));
    header_.map_bytes = section.at + records.size() * sizeof(Record);
    return section;
}

std::vector<std::byte> SampleMap::build() {
    std::vector<std::byte> block(end_);
    std::memcpy(block.data() + sizeof(map::Header), texts_.data(), texts_.size());
    header_.map_bytes = sizeof(map::Header) + texts_.size();
    header_.texts = {sizeof(map::Header), static_cast<std::uint32_t>(texts_.size()), 1, 0};
    header_.components = lay(block, components_);
    header_.facets = lay(block, facets_);
    header_.activities = lay(block, activities_);
    header_.connections = lay(block, connections_);
    header_.reactions = lay(block, reactions_);
    header_.behaviours = lay(block, behaviours_);
    header_.types = lay(block, types_);
    header_.fields = lay(block, fields_);
    header_.enumerators = lay(block, enumerators_);
    header_.figures = lay(block, figures_);
    header_.block_bytes = block.size();
    std::memcpy(block.data(), &header_, sizeof header_);
    return block;
}

SampleMachine::SampleMachine() {
    const std::uint32_t motion = map_.activity("motion");
    const std::uint32_t logic = map_.activity("logic");
    const std::uint32_t angle_list = map_.record("arguments", {{"", map_.f64}}, map::Shape::arguments);
    const std::uint32_t no_list = map_.record("arguments", {}, map::Shape::arguments);
    const std::uint32_t states = map_.enumeration("State", 1, {{"stopped", 0}, {"weaving", 1}});
    const auto add = [&](std::string_view component, std::string_view name, std::string_view kind,
                         std::uint32_t type, std::uint32_t activity, std::string_view unit,
                         std::string_view doc, std::uint32_t flags) {
        const std::uint32_t index = map_.facet(name, kind, type, unit, doc, flags);
        names_.emplace(std::string{component} + "." + std::string{name}, index);
        activity_of_.emplace(index, activity);
        return index;
    };
    map_.component("shaft", "MainShaft", motion, "encoder");
    const auto angle =
        add("shaft", "angle", "output", map_.f64, motion, "deg", "of the main shaft", map::facet_can_force);
    add("shaft", "gains.p", "property", map_.f64, motion, "N/deg", "proportional gain", 0);
    add("shaft", "gains.i", "property", map_.f64, motion, "N/deg/s", "integral gain", 0);
    add("shaft", "stop", "command", angle_list, motion, "", "stops at an angle", map::facet_for_people);
    add("shaft", "beat_up", "event", angle_list, motion, "", "the reed is at the fell", 0);
    add("shaft", "reset", "method", no_list, motion, "", "forgets the stops", 0);
    map_.component("loom", "Loom", logic);
    const auto seen =
        add("loom", "angle", "input", map_.f64, logic, "deg", "as the logic sees it", map::facet_can_force);
    add("loom", "lamp", "output", map_.boolean, logic, "", "the green one", map::facet_can_force);
    add("loom", "state", "output", states, logic, "", "what it does", 0);
    add("loom", "run", "command", angle_list, logic, "", "turns the shaft",
        map::facet_for_people | map::facet_moves);
    map_.connect(angle, seen, 4'000'000);
    map_.react("tell", names_.at("shaft.beat_up"), names_.at("shaft.reset"));
    map_.figure(map::Owner::activity, motion, "cycles", map_.i32);
    const std::vector<std::byte> built = map_.build();

    memory_ = ::memfd_create("sample", MFD_CLOEXEC);
    static_cast<void>(::ftruncate(memory_, static_cast<off_t>(built.size())));
    void* const at = ::mmap(nullptr, built.size(), PROT_READ | PROT_WRITE, MAP_SHARED, memory_, 0);
    block_ = {static_cast<std::byte*>(at), built.size()};
    std::ranges::copy(built, block_.begin());

    path_ = directory_ / "sample.socket";
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::ranges::copy(path_, address.sun_path);
    listener_ = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    static_cast<void>(::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address));
    static_cast<void>(::listen(listener_, 8));
    server_ = std::thread{[this] { serve(); }};
}

SampleMachine::~SampleMachine() {
    end();
    ::munmap(block_.data(), block_.size());
    ::close(memory_);
}

void SampleMachine::end() {
    ending_ = true;
    if (server_.joinable()) server_.join();
    if (listener_ >= 0) ::close(listener_);
    listener_ = -1;
}

std::uint32_t SampleMachine::index_of(std::string_view facet) const { return names_.find(facet)->second; }

std::atomic_ref<std::uint64_t> SampleMachine::generation(std::uint32_t facet) const {
    const map::Activity& activity = map_.activities()[activity_of_.at(facet)];
    return std::atomic_ref{*reinterpret_cast<std::uint64_t*>(block_.data() + activity.generation_at)};
}

void SampleMachine::write_bytes(std::string_view name, std::span<const std::byte> bytes,
                                std::int64_t stamp_ns) {
    const std::uint32_t index = index_of(name);
    const map::Facet& facet = map_.facets()[index];
    const auto count = generation(index);
    count.fetch_add(1);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        __atomic_store_n(reinterpret_cast<unsigned char*>(block_.data() + facet.value_at + i),
                         static_cast<unsigned char>(bytes[i]), __ATOMIC_RELAXED);
    if (facet.stamp_at != 0) std::memcpy(block_.data() + facet.stamp_at, &stamp_ns, sizeof stamp_ns);
    if (facet.writes_at != 0) ++*reinterpret_cast<std::uint64_t*>(block_.data() + facet.writes_at);
    count.fetch_add(1);
}

void SampleMachine::force(std::string_view name, bool forced, double value) {
    const map::Facet& facet = map_.facets()[index_of(name)];
    std::memcpy(block_.data() + facet.forced_value_at, &value, sizeof value);
    block_[facet.forced_at] = static_cast<std::byte>(forced ? 1 : 0);
    *reinterpret_cast<std::uint32_t*>(block_.data() + map_.header().forced_at) = forced ? 1 : 0;
}

void SampleMachine::hold(std::string_view facet, bool in_cycle) {
    const auto count = generation(index_of(facet));
    if ((count.load() % 2 != 0) != in_cycle) count.fetch_add(1);
}

void SampleMachine::set_now(std::string_view facet, std::int64_t now_ns) {
    const map::Activity& activity = map_.activities()[activity_of_.at(index_of(facet))];
    std::memcpy(block_.data() + activity.now_at, &now_ns, sizeof now_ns);
}

void SampleMachine::answer(std::string_view request, std::vector<std::string> packets) {
    const std::scoped_lock lock{mutex_};
    answers_.emplace_back(std::string{request}, std::move(packets));
}

std::vector<std::string> SampleMachine::requests() const {
    const std::scoped_lock lock{mutex_};
    return requests_;
}

std::vector<std::string> SampleMachine::asked() const {
    std::vector<std::string> all = requests();
    std::erase_if(all, [](const std::string& each) { return each == "hello" || each == "map"; });
    return all;
}

void SampleMachine::reply(int client, std::string_view text) {
    const std::size_t blank = text.find(' ');
    const std::string number{text.substr(0, blank)};
    const std::string request{text.substr(blank + 1)};
    std::vector<std::string> packets{R"({"id": %, "ok": true})"};
    {
        const std::scoped_lock lock{mutex_};
        requests_.push_back(request);
        for (const auto& [begin, answers] : answers_)
            if (request.starts_with(begin)) packets = answers;
    }
    if (request == "hello")
        packets = {R"({"id": %, "ok": true, "protocol": 1, "machine": "sample", "role": ")" + role + R"("})"};
    for (std::string packet : packets) {
        if (const std::size_t at = packet.find('%'); at != std::string::npos) packet.replace(at, 1, number);
        iovec place{packet.data(), packet.size()};
        const std::array passed{memory_, memory_}; // one more than a browser accepts
        alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof passed)> control{};
        msghdr message{};
        message.msg_iov = &place;
        message.msg_iovlen = 1;
        if (request == "map") {
            message.msg_control = control.data();
            message.msg_controllen = control.size();
            cmsghdr* const header = CMSG_FIRSTHDR(&message);
            header->cmsg_level = SOL_SOCKET;
            header->cmsg_type = SCM_RIGHTS;
            header->cmsg_len = CMSG_LEN(sizeof passed);
            std::memcpy(CMSG_DATA(header), passed.data(), sizeof passed);
        }
        static_cast<void>(::sendmsg(client, &message, MSG_NOSIGNAL));
    }
}

void SampleMachine::serve() {
    std::vector<int> clients;
    while (!ending_) {
        std::vector<pollfd> looks{{listener_, POLLIN, 0}};
        for (const int client : clients) looks.push_back({client, POLLIN, 0});
        if (::poll(looks.data(), looks.size(), 10) <= 0) continue;
        for (std::size_t i = 1; i < looks.size(); ++i) {
            if (looks[i].revents == 0) continue;
            std::array<char, 8192> packet{};
            const ssize_t count = ::recv(looks[i].fd, packet.data(), packet.size(), 0);
            if (count > 0) {
                reply(looks[i].fd, {packet.data(), static_cast<std::size_t>(count)});
            } else {
                ::close(looks[i].fd);
                std::erase(clients, looks[i].fd);
            }
        }
        if (looks[0].revents != 0)
            if (const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC); client >= 0)
                clients.push_back(client);
    }
    for (const int client : clients) ::close(client);
}

} // namespace tappet::browser
