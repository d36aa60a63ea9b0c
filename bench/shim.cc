// SPDX-License-Identifier: MIT
//
// shim.cc - Google Benchmark behind the C functions of bench.h.
#include "bench.h"

#include <benchmark/benchmark.h>

#include <string>

void bench_add(const char *name, void (*run)(void *argument), void *argument, size_t items) {
    benchmark::RegisterBenchmark(name,
                                 [=](benchmark::State &state) {
                                     for (auto _ : state)
                                         run(argument);
                                     state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * items));
                                 })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
}

void bench_skip(const char *name, const char *reason) {
    const std::string why = reason;
    benchmark::RegisterBenchmark(name, [=](benchmark::State &state) {
        state.SkipWithError(why.c_str());
        for (auto _ : state) {
        }
    });
}

int bench_run(int argc, char **argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv))
        return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
