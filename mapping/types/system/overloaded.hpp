// overloaded.hpp: combines lambdas into the visitor of a std::variant, one lambda per alternative.
#pragma once

namespace roomradar {

/// Argument of std::visit. The overload that matches the variant's value is called.
template <typename... Lambdas>
struct overloaded : Lambdas... {
  using Lambdas::operator()...;
};
template <typename... Lambdas>
overloaded(Lambdas...) -> overloaded<Lambdas...>;

}  // namespace roomradar
