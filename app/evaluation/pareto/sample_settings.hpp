// draw_settings.hpp: which settings a sweep tries, drawn by seed.
#pragma once
#include <cstdint>
#include <vector>

#include "app/evaluation/pareto/parameter.hpp"

namespace roomradar {

/// Up to `count` settings, no two alike and none the usual one, in random order. Up to two thirds of them
/// turn one knob alone (as many as there are such settings; those towards what is faster come first, for
/// fronts are made of them, and of these the next word of every knob before any farther one), which shows
/// what each knob does; the others turn all of quality at once: each knob's words come about equally often,
/// at random, but so that what is fast is mixed with what is fast rather than with what is slow, for only
/// such mixtures can be on a front. Every word of every knob of quality occurs among the mixtures where these
/// are as many as it has words; fewer come where there are not so many to be found. The same for the same
/// seed.
std::vector<Setting> draw_settings(const std::vector<Parameter>& parameters, std::size_t count,
                                   std::uint64_t seed);

}  // namespace roomradar
