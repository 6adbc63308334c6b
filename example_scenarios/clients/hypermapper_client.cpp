// Let an optimizer that speaks HyperMapper's client-server protocol minimize a function of this program.
//
//     g++ -std=c++17 -O2 hypermapper_client.cpp -o hypermapper_client
//     ./hypermapper_client [COMMAND ...] SCENARIO.json
//
// The command starts the optimizer, and defaults to `python3 -m hypermap_lite`; with the environment variable
// HYPERMAPPER_HOME it defaults to `python3 $HYPERMAPPER_HOME/hypermapper/optimizer.py`. The scenario must say
// "hypermapper_mode": {"mode": "client-server"} and have the parameters, objectives and feasibility column of the
// function: ../hypermapper/chakong_haimes_client_server.json does. Only the C++ and POSIX libraries are needed.

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iomanip>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Cells = std::vector<std::string>;

const std::string kEnd = "End of HyperMapper";
const std::string kRequest = "Request ";
const std::string kHeader = "x1,x2,f1,f2,Valid";  // of an answer: the parameters as they came, then the results

struct Result {
    double f1;
    double f2;
    bool is_valid;
};

// Configurations to evaluate, as text: what is sent back must be what came.
struct Request {
    Cells names;
    std::vector<Cells> rows;
};

// The two objectives of Chankong and Haimes (1983), and whether both constraints hold.
Result evaluate(double x1, double x2) {
    const double a = x1 - 2, b = x2 - 1;
    return {2 + a * a + b * b, 9 * x1 - b * b, x1 * x1 + x2 * x2 <= 225 && x1 - 3 * x2 + 10 <= 0};
}

Cells cells_of(const std::string& line) {
    Cells cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) {
        const auto first = cell.find_first_not_of(" \t\r");
        const auto last = cell.find_last_not_of(" \t\r");
        cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    }
    return cells;
}

// The optimizer as a child process: its standard input and output are our pipes, its standard error is ours.
class Optimizer {
  public:
    explicit Optimizer(const Cells& command) {
        std::array<int, 2> to_child{}, from_child{};
        if (pipe(to_child.data()) != 0 || pipe(from_child.data()) != 0) {
            throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
        }
        child_ = fork();
        if (child_ < 0) throw std::runtime_error(std::string("no child process: ") + std::strerror(errno));
        if (child_ == 0) {
            dup2(to_child[0], STDIN_FILENO);
            dup2(from_child[1], STDOUT_FILENO);
            for (const int end : {to_child[0], to_child[1], from_child[0], from_child[1]}) close(end);
            become(command);
        }
        close(to_child[0]);
        close(from_child[1]);
        to_ = fdopen(to_child[1], "w");
        from_ = fdopen(from_child[0], "r");
    }

    Optimizer(const Optimizer&) = delete;
    Optimizer& operator=(const Optimizer&) = delete;

    ~Optimizer() { finish(); }

    // The next line without its end, of any length; nothing when the optimizer has stopped.
    std::optional<std::string> read_line() {
        std::string line;
        for (int c = std::fgetc(from_); c != EOF; c = std::fgetc(from_)) {
            if (c == '\n') return line;
            line += static_cast<char>(c);
        }
        return line.empty() ? std::nullopt : std::optional(line);
    }

    void write(const std::string& text) {
        if (std::fputs(text.c_str(), to_) < 0 || std::fflush(to_) != 0) {
            throw std::runtime_error("the optimizer does not read the answer");
        }
    }

    // Wait for the end of the child and return its exit status.
    int finish() {
        if (child_ == 0) return status_;
        std::fclose(to_);
        std::fclose(from_);
        int state = 0;
        waitpid(child_, &state, 0);
        child_ = 0;
        status_ = WIFEXITED(state) ? WEXITSTATUS(state) : 1;
        return status_;
    }

  private:
    [[noreturn]] static void become(const Cells& command) {
        std::vector<char*> arguments;
        for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        execvp(arguments[0], arguments.data());
        std::cerr << command[0] << ": " << std::strerror(errno) << std::endl;
        _exit(127);
    }

    pid_t child_ = 0;
    std::FILE* to_ = nullptr;
    std::FILE* from_ = nullptr;
    int status_ = 1;
};

std::string require_line(Optimizer& optimizer, const std::string& what) {
    if (auto line = optimizer.read_line()) return *line;
    throw std::runtime_error("the optimizer stopped before it had written " + what);
}

// The next request, or nothing after the last; other lines, as warnings, are passed over.
std::optional<Request> next_request(Optimizer& optimizer) {
    while (auto line = optimizer.read_line()) {
        if (line->find(kEnd) != std::string::npos) return std::nullopt;
        if (line->compare(0, kRequest.size(), kRequest) != 0) continue;
        const int n = std::stoi(line->substr(kRequest.size()));
        Request request{cells_of(require_line(optimizer, "the names of the parameters")), {}};
        for (int i = 1; i <= n; ++i) {
            const std::string what = "row " + std::to_string(i) + " of " + std::to_string(n);
            request.rows.push_back(cells_of(require_line(optimizer, what)));
        }
        return request;
    }
    throw std::runtime_error("the optimizer stopped without '" + kEnd + "'");
}

std::string answer(const Request& request) {
    std::ostringstream text;
    text << std::setprecision(std::numeric_limits<double>::max_digits10) << kHeader << '\n';
    for (const auto& row : request.rows) {
        std::map<std::string, std::string> values;
        for (std::size_t i = 0; i < request.names.size(); ++i) values[request.names[i]] = row.at(i);
        const auto& x1 = values.at("x1");
        const auto& x2 = values.at("x2");
        const Result result = evaluate(std::stod(x1), std::stod(x2));
        text << x1 << ',' << x2 << ',' << result.f1 << ',' << result.f2 << ',' << (result.is_valid ? "True" : "False")
             << '\n';
    }
    return text.str();
}

Cells command_of(int argc, char** argv) {
    Cells command(argv + 1, argv + argc);
    if (command.size() > 1) return command;
    const char* home = std::getenv("HYPERMAPPER_HOME");
    if (home != nullptr) return {"python3", std::string(home) + "/hypermapper/optimizer.py", command[0]};
    return {"python3", "-m", "hypermap_lite", command[0]};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::cerr << "usage: hypermapper_client [COMMAND ...] SCENARIO.json" << std::endl;
        return 2;
    }
    std::signal(SIGPIPE, SIG_IGN);  // an optimizer that has stopped is an error to report, not the end of this program
    try {
        Optimizer optimizer(command_of(argc, argv));
        std::size_t n = 0;
        while (const auto request = next_request(optimizer)) {
            optimizer.write(answer(*request));
            n += request->rows.size();
        }
        std::cout << n << " configurations evaluated" << std::endl;
        return optimizer.finish();
    } catch (const std::exception& error) {
        std::cerr << argv[argc - 1] << ": " << error.what() << std::endl;
        return 1;
    }
}
