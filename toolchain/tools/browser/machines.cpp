// Finds the sockets, and the machines that answer there.
#include "toolchain/tools/browser/machines.hpp"

#include <algorithm>
#include <filesystem>

namespace tappet::browser {

namespace {

std::vector<std::string> sockets_in(const std::string& directory) {
    std::vector<std::string> found;
    std::error_code error;
    for (std::filesystem::directory_iterator each{directory, error}, end; !error && each != end;
         each.increment(error))
        if (each->path().native().ends_with(browsing::socket_suffix)) found.push_back(each->path().native());
    std::ranges::sort(found);
    return found;
}

/// Parses "NAME=FILE", or "FILE", which takes the name of the file.
Machine machine_at(std::string_view given) {
    const std::size_t equals = given.find('=');
    if (equals != std::string_view::npos && equals > 0 && given.find('/') > equals)
        return {std::string{given.substr(0, equals)}, std::string{given.substr(equals + 1)}};
    std::string name = std::filesystem::path{given}.filename().string();
    if (name.ends_with(browsing::socket_suffix)) name.resize(name.size() - browsing::socket_suffix.size());
    return {std::move(name), std::string{given}};
}

} // namespace

Result<Machines> Machines::find(const Line& line, std::optional<User> user) {
    Machines machines;
    machines.user_ = std::move(user);
    machines.patience_ = line.patience;
    const bool are_given = !line.sockets.empty();
    machines.place_ = are_given ? "among those given" : "in '" + line.directory + "'";
    for (const std::string& each : are_given ? line.sockets : sockets_in(line.directory))
        machines.all_.push_back(machine_at(each));
    if (machines.all_.empty() && machines.user_)
        return failure(Fault::no_machine, "no machine runs there; start one at its box");
    if (machines.all_.empty())
        return failure(Fault::no_machine, "no machine has a socket in '" + line.directory +
                                              "'; start one, or name its socket with --socket");
    for (std::size_t i = 0; i < machines.all_.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (machines.all_[i].name == machines.all_[k].name)
                return failure(Fault::bad_request, "two machines are called '" + machines.all_[i].name +
                                                       "' (" + machines.all_[k].socket + ", " +
                                                       machines.all_[i].socket +
                                                       "); give one another name: --socket NAME=FILE");
    if (machines.are_several()) return machines;
    auto opened = Session::open(machines.all_[0].socket, line.patience, {}, machines.user());
    if (!opened) return std::unexpected(opened.error());
    machines.all_[0].session = std::move(*opened);
    return machines;
}

Machines Machines::of(std::unique_ptr<Session> session) {
    Machines machines;
    machines.all_.push_back({std::string{session->map().text(session->map().header().machine)},
                             session->link().path(), std::move(session)});
    return machines;
}

Machine* Machines::named(std::string_view word) {
    for (Machine& each : all_)
        if (word == each.name || (word.starts_with(each.name) && word[each.name.size()] == '.')) return &each;
    return nullptr;
}

Result<Session*> Machines::reach(Machine& machine) {
    if (machine.session != nullptr && (!are_several() || !machine.session->link().ended()))
        return machine.session.get();
    machine.session.reset();
    auto opened = Session::open(machine.socket, patience_, machine.name + ".", user());
    if (!opened)
        return failure(opened.error().fault,
                       "'" + machine.name + "' does not answer: " + opened.error().sentence);
    machine.session = std::move(*opened);
    return machine.session.get();
}

std::vector<Session*> Machines::reachable() {
    std::vector<Session*> sessions;
    for (Machine& each : all_)
        if (const auto session = reach(each)) sessions.push_back(*session);
    return sessions;
}

std::string Machines::names() const {
    std::string text;
    for (const Machine& each : all_) text += (text.empty() ? "" : ", ") + each.name;
    return text;
}

} // namespace tappet::browser
