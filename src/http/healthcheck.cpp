// `vines healthcheck`: queries a running service, for containers without curl.
#include <httplib.h>

#include <memory>
#include <string>

#include "http/commands.hpp"
#include "program/subcommand.hpp"

namespace vines::http {

namespace {

struct Target {
    std::string host = "127.0.0.1";
    int port = 8080;
};

/// True if GET /healthz is answered with 200 within 2 s.
bool is_healthy(const Target& target) {
    httplib::Client client(target.host, target.port);
    client.set_connection_timeout(2);  // s
    client.set_read_timeout(2);
    const auto result = client.Get("/healthz");
    return result && result->status == 200;
}

}  // namespace

Command add_healthcheck(CLI::App& app) {
    const auto target = std::make_shared<Target>();
    CLI::App* command =
        app.add_subcommand("healthcheck", "check a running service: exit code 0 if healthy");
    command->add_option("--host", target->host, "address of the service")->capture_default_str();
    command->add_option("--port", target->port, "port of the service")
        ->envname("VINES_PORT")
        ->capture_default_str();
    add_examples(*command, "vines healthcheck --port 8080 && echo well");
    return {command, [target] { return is_healthy(*target) ? 0 : 1; }};
}

}  // namespace vines::http
