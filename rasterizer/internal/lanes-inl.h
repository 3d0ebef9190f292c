// What kernels of several stages share. Included once per target by each file that compiles kernels.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// floor(v + 0.5) as integers, as roundToInt().
template <class D, class V = hn::Vec<D>>
hn::Vec<hn::RebindToSigned<D>> roundLanes(D d, V v) {
    return hn::ConvertTo(hn::RebindToSigned<D>(), hn::Floor(hn::Add(v, hn::Set(d, 0.5f))));
}

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
