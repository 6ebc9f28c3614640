// Routes requests, and checks origins, cookies and passwords.
#include "toolchain/tools/gateway/site.hpp"

#include "kernel/base/nearest.hpp"
#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/page.hpp"
#include "toolchain/tools/gateway/schema.json.hpp"

#include <algorithm>

namespace tappet::network {

namespace {

constexpr std::string_view html = "text/html; charset=utf-8";

HttpReply plain(unsigned status, std::string text) {
    return {status, "text/plain; charset=utf-8", std::move(text) + "\n", {}};
}

std::string lower(std::string_view text) {
    std::string all{text};
    std::ranges::transform(all, all.begin(), tappet::lower_case);
    return all;
}

/// Returns the host without its port.
std::string_view name_of(std::string_view host) {
    const std::size_t bracket = host.rfind(']');
    const std::size_t colon = host.rfind(':');
    return colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket)
               ? host.substr(0, colon)
               : host;
}

bool is_loopback(std::string_view host) {
    const std::string name = lower(name_of(host));
    return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

struct Basic {
    std::string user{}, password{};
};

std::optional<Basic> basic_of(std::string_view header) {
    constexpr std::string_view scheme = "basic ";
    if (lower(header.substr(0, scheme.size())) != scheme) return std::nullopt;
    const auto both = from_base64(header.substr(scheme.size()));
    if (!both || !both->contains(':')) return std::nullopt;
    const std::size_t colon = both->find(':');
    return Basic{both->substr(0, colon), both->substr(colon + 1)};
}

/// Returns whether a list of protocols, "a, b", contains ours.
bool offers_ours(std::string_view protocols) {
    while (!protocols.empty()) {
        std::string_view each = protocols.substr(0, protocols.find(','));
        protocols.remove_prefix(std::min(protocols.size(), each.size() + 1));
        while (each.starts_with(' ')) each.remove_prefix(1);
        while (each.ends_with(' ')) each.remove_suffix(1);
        if (each == subprotocol) return true;
    }
    return false;
}

} // namespace

std::vector<std::pair<std::string, std::string>> safe_headers() {
    return {{"Content-Security-Policy",
             "default-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'"},
            {"X-Content-Type-Options", "nosniff"},
            {"X-Frame-Options", "DENY"},
            {"Referrer-Policy", "same-origin"},
            {"Cross-Origin-Resource-Policy", "same-origin"},
            {"Cache-Control", "no-store"}};
}

std::string Site::cookie(std::string_view token, bool over) const {
    return cookie_name() + "=" + std::string{token} + "; Path=/; HttpOnly; SameSite=Strict" +
           (encrypted_ ? "; Secure" : "") + (over ? "; Max-Age=0" : "");
}

std::string Site::fault_in_origin(const HttpRequest& request, bool needed) const {
    // Without a users file the gateway trusts the loopback, so no other name may lead there (DNS rebinding).
    if (hub_.access().local() && !is_loopback(request.host))
        return "this gateway is for the loopback; use the address 127.0.0.1, [::1] or localhost";
    if (request.origin.empty())
        return needed ? "a request with a cookie needs an Origin; use a browser, or log in by message" : "";
    const std::string own = std::string{encrypted_ ? "https://" : "http://"} + lower(request.host);
    return lower(request.origin) == own ? ""
                                        : "the page that asks is from '" + as_utf8(cut(request.origin, 100)) +
                                              "', not from here; open this gateway's own page";
}

std::optional<LoggedIn> Site::who(const HttpRequest& request, std::string& token, bool use) {
    if (hub_.access().local()) return hub_.access().local();
    const auto cookie = cookie_of(request.cookie, cookie_name());
    if (!cookie || cookie->empty()) return std::nullopt;
    auto found = hub_.access().find(*cookie, Clock::now(), use);
    if (found) token = *cookie;
    return found;
}

std::variant<HttpReply, Admission> Site::upgrade(const HttpRequest& request) {
    if (request.target != "/v1") return plain(404, "the WebSocket is at /v1");
    if (!offers_ours(request.protocols)) return plain(400, "ask for the subprotocol tappet.v1");
    Admission admission;
    admission.who = who(request, admission.token);
    const bool by_cookie = admission.who.has_value() && !hub_.access().local();
    if (const std::string fault = fault_in_origin(request, by_cookie); !fault.empty())
        return plain(403, fault);
    return admission;
}

void Site::answer(const HttpRequest& request, OnReply reply) {
    const std::string target = request.target.substr(0, request.target.find('?'));
    if (hub_.access().local() && !is_loopback(request.host))
        return reply(plain(403, fault_in_origin(request, false)));
    if (request.method == "POST") return post(request, std::move(reply));
    if (request.method != "GET" && request.method != "HEAD") {
        HttpReply refusal = plain(405, "GET, HEAD and POST are served here");
        refusal.headers.emplace_back("Allow", "GET, HEAD, POST");
        return reply(std::move(refusal));
    }
    if (target == "/page.css") return reply({200, "text/css; charset=utf-8", std::string{page_style()}, {}});
    if (target == "/v1/schema.json")
        return reply({200, "application/schema+json", std::string{files::schema_json.text}, {}});
    if (target == "/metrics") return metrics(request, std::move(reply));
    if (target == "/v1") return reply(plain(426, "/v1 is a WebSocket of the subprotocol tappet.v1"));
    if (target != "/" && target != "/login")
        return reply(plain(404, "there is /, /metrics, /v1 and /v1/schema.json"));
    std::string token;
    const auto user = who(request, token, false); // the page refreshes itself, also when nobody looks at it
    if (!user) return reply({200, std::string{html}, login_page({}), {}});
    reply({200, std::string{html}, values_page(hub_.stations(), *user, !hub_.access().local()), {}});
}

void Site::post(const HttpRequest& request, OnReply reply) {
    if (request.target != "/login" && request.target != "/logout")
        return reply(plain(404, "POST is for /login and /logout"));
    if (const std::string fault = fault_in_origin(request, !request.cookie.empty()); !fault.empty())
        return reply(plain(403, fault));
    if (request.target == "/logout") {
        std::string token;
        if (who(request, token)) hub_.access().end(token);
        return reply(
            {303, "text/plain; charset=utf-8", {}, {{"Location", "/"}, {"Set-Cookie", cookie({}, true)}}});
    }
    const auto form = from_form(request.body);
    if (!form) return reply(plain(400, "the body is no form: user=..&password=.."));
    std::string user, password;
    for (const auto& [name, value] : *form) {
        if (name == "user") user = value;
        if (name == "password") password = value;
    }
    hub_.login(user, password, request.address, [this, reply = std::move(reply)](auto outcome) {
        if (!outcome) return reply({401, std::string{html}, login_page(outcome.error()), {}});
        reply({303,
               "text/plain; charset=utf-8",
               {},
               {{"Location", "/"}, {"Set-Cookie", cookie(outcome->token, false)}}});
    });
}

void Site::metrics(const HttpRequest& request, OnReply reply) {
    const bool open = request.accept.contains("application/openmetrics-text");
    const auto send = [this, open](const OnReply& to) {
        to({200,
            open ? "application/openmetrics-text; version=1.0.0; charset=utf-8"
                 : "text/plain; version=0.0.4; charset=utf-8",
            metrics_text(hub_.stations(), hub_.counters(), open ? MetricsForm::open : MetricsForm::plain),
            {}});
    };
    std::string token;
    if (who(request, token)) return send(reply);
    const auto basic = basic_of(request.authorization);
    if (!basic) return reply(plain(401, "log in, or send user and password (basic_auth of Prometheus)"));
    if (hub_.access().remembered(basic->user, basic->password, request.address, Clock::now()))
        return send(reply);
    hub_.login(basic->user, basic->password, request.address,
               [this, basic, send, reply = std::move(reply)](auto outcome) {
                   if (!outcome) return reply(plain(401, outcome.error()));
                   hub_.access().remember(basic->user, basic->password, outcome->token);
                   send(reply);
               });
}

} // namespace tappet::network
