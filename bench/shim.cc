// SPDX-License-Identifier: MIT
//
// shim.cc - Google Benchmark behind the C functions of bench.h.
#include "bench.h"

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace {

std::map<std::string, bench_row *> rows;

// Google Benchmark's console, but of several repetitions it shows the median alone, which becomes the row's result.
class Console : public benchmark::ConsoleReporter {
    void ReportRuns(const std::vector<Run> &runs) override {
        std::vector<Run> shown;
        for (const Run &run : runs) {
            if (run.run_type == Run::RT_Iteration ? run.repetitions > 1 : run.aggregate_name != "median")
                continue;
            shown.push_back(run);
            const auto row = rows.find(run.run_name.function_name);
            const auto time = run.counters.find("per_question");
            if (row != rows.end() && time != run.counters.end())
                row->second->ns = time->second * 1e9;
        }
        if (!shown.empty())
            ConsoleReporter::ReportRuns(shown);
    }

  public:
    Console() : ConsoleReporter(OO_Tabular) {}
};

} // namespace

void bench_add(bench_row *row) {
    const auto measure = [row](benchmark::State &state) {
        using benchmark::Counter;
        row->prepare(row);
        for (auto _ : state) {
            row->run(row);
            if (row->own_clock)
                state.SetIterationTime(row->seconds);
        }
        // The reciprocal of a rate of questions: seconds, shown as nanoseconds.
        state.counters["per_question"] =
            Counter(static_cast<double>(row->count), Counter::kIsIterationInvariantRate | Counter::kInvert);
        state.counters["hits"] = row->hits;
        state.counters["wrong"] = row->wrong;
    };
    rows[row->name] = row;
    auto *registered = benchmark::RegisterBenchmark(row->name, measure)->Unit(benchmark::kMicrosecond);
    if (row->own_clock)
        registered->UseManualTime();
    else if (row->threaded)
        registered->UseRealTime();
}

void bench_skip(const char *name, const char *reason) {
    const std::string why = reason;
    benchmark::RegisterBenchmark(name, [why](benchmark::State &state) {
        state.SkipWithError(why.c_str());
        for (auto _ : state) {
        }
    });
}

void bench_describe(const char *key, const char *value) { benchmark::AddCustomContext(key, value); }

int bench_run(int argc, char **argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv))
        return 2;
    Console console;
    const size_t found = benchmark::RunSpecifiedBenchmarks(&console);
    benchmark::Shutdown();
    return found > 0 ? 0 : 1;
}
