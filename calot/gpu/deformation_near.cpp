// The search for near hexels (kernels/near.cl) from the host's side.

#include <algorithm>

#include "calot/gpu/deformation.h"

namespace calot::gpu {

namespace {

constexpr int kGroup = 64;
constexpr int kHexels = 64;  // HEXELS of kernels/near.cl
/// Groups that share the near phyxels.
constexpr std::int64_t kGroups = 256;
/// Near hexels that are read together with their number.
constexpr std::int64_t kReadAtOnce = 512;
constexpr std::int64_t kWords = sizeof(GpuNearHexel) / 4;

}  // namespace

void Deformation::reserve_near(std::int64_t phyxels, std::int64_t hexels) {
    most_near_phyxels_ = phyxels;
    most_near_hexels_ = hexels;
    near_list_ = DeviceArray<std::int32_t>(*device_, phyxels);
    near_counts_ = DeviceArray<std::int32_t>(*device_, phyxels);
    near_mask_ = DeviceArray<std::uint32_t>(*device_, 2 * phyxels);
    near_found_ = DeviceArray<std::uint32_t>(*device_, kHexels * kWords * phyxels);
    near_out_ = DeviceArray<std::uint32_t>(*device_, kWords * (2 + hexels));
    scan_ = Scan(device_, std::max(phyxels, active_.size()));
}

GpuNear Deformation::near_parameters(const deformation::Capsules& capsules) const {
    GpuNear k{};
    k.embedding = embedding_;
    k.phyxel_margin = static_cast<float>(deformation::kPhyxelMargin * model_->phyxels.spacing_m);
    k.half_hexel = static_cast<float>(0.5 * model_->hexels.spacing_m);
    Vec3f low(1e9f), high(-1e9f);  // as find_near_phyxels
    for (std::size_t n = 0; n < capsules.count; ++n) {
        const deformation::CapsuleF& capsule = capsules.item[n];
        const Vec3f b = capsule.a + capsule.ab, most(capsule.radius + (capsule.reach + k.phyxel_margin));
        low = glm::min(low, glm::min(capsule.a, b) - most);
        high = glm::max(high, glm::max(capsule.a, b) + most);
    }
    for (int r = 0; r < 3; ++r) {
        k.low[r] = low[r];
        k.high[r] = high[r];
    }
    const deformation::NeighbourRows rows(model_->hexels);
    for (std::size_t row = 0; row < rows.offset.size(); ++row)
        k.row_offset[row] = static_cast<std::int32_t>(rows.offset[row]);
    k.active = static_cast<std::int32_t>(active_.size());
    k.most_phyxels = static_cast<std::int32_t>(most_near_phyxels_);
    k.most_hexels = static_cast<std::int32_t>(most_near_hexels_);
    return k;
}

void Deformation::find_near(tissue::Exchange& exchange, const deformation::NearReach& reach) {
    exchange.near.clear();
    if (exchange.capsules.empty()) return;
    const deformation::Capsules capsules(exchange.capsules, reach);
    GpuCapsules list{};
    list.count = static_cast<std::int32_t>(capsules.count);
    for (std::size_t n = 0; n < capsules.count; ++n) {
        const deformation::CapsuleF& from = capsules.item[n];
        GpuCapsule& to = list.item[n];
        for (int r = 0; r < 3; ++r) {
            to.a[r] = from.a[r];
            to.ab[r] = from.ab[r];
        }
        to.per_length2 = from.inverse_length2;
        to.radius = from.radius;
        to.reach = from.reach;
        to.bare = from.bare ? 1 : 0;
    }
    device_->write(capsules_.buffer(), &list, sizeof(list));

    Arrays& a = *arrays_;
    std::vector<GpuNearHexel>& found = found_;
    for (;;) {
        const GpuNear k = near_parameters(capsules);
        device_->launch(near_phyxels_, k.active, kGroup, k, capsules_, active_, a.phyxel_present, phyxel_centres_,
                        a.displacement_m, is_near_);
        scan_.exclusive(is_near_, k.active, near_total_);
        device_->launch(list_phyxels_, k.active, kGroup, k, active_, is_near_, near_total_, near_list_);
        device_->fill_zero(near_counts_.buffer());
        device_->launch(near_hexels_, kGroups * kHexels, kHexels, k, capsules_, near_list_, near_total_,
                        phyxel_centres_, hexel_centres_, outwards_, words_, a.displacement_m, gradient_,
                        a.hexel_present, a.hexel_held, near_found_, near_mask_, near_counts_);
        scan_.exclusive(near_counts_, most_near_phyxels_, near_hexel_total_);
        device_->launch(list_hexels_, most_near_phyxels_ * kHexels, kHexels, k, near_total_, near_hexel_total_,
                        near_mask_, near_counts_, near_found_, near_out_);
        const std::int64_t room = std::min(most_near_hexels_, kReadAtOnce);
        found.resize(static_cast<std::size_t>(2 + room));
        device_->read(near_out_.buffer(), found.data(), found.size() * sizeof(GpuNearHexel));
        const std::int64_t hexels = found[0].hexel, phyxels = found[1].hexel;
        if (phyxels > most_near_phyxels_ || hexels > most_near_hexels_) {
            reserve_near(std::max(2 * phyxels, most_near_phyxels_), std::max(2 * hexels, most_near_hexels_));
            continue;
        }
        found.resize(static_cast<std::size_t>(2 + hexels));
        if (hexels > room)
            device_->read(near_out_.buffer(), found.data() + 2 + room,
                          static_cast<std::size_t>(hexels - room) * sizeof(GpuNearHexel),
                          static_cast<std::size_t>(2 + room) * sizeof(GpuNearHexel));
        break;
    }
    const auto first = found.begin() + 2;
    if (found.end() - first > tissue::kNearCapacity) {  // the nearest are kept
        std::nth_element(first, first + tissue::kNearCapacity, found.end(),
                         [](const GpuNearHexel& x, const GpuNearHexel& y) {
                             return x.distance != y.distance ? x.distance < y.distance : x.hexel < y.hexel;
                         });
        found.erase(first + tissue::kNearCapacity, found.end());
    }
    std::sort(found.begin() + 2, found.end(),
              [](const GpuNearHexel& x, const GpuNearHexel& y) { return x.hexel < y.hexel; });
    for (auto from = found.begin() + 2; from != found.end(); ++from) {
        tissue::NearHexel& to = exchange.near.emplace_back();
        to.hexel = from->hexel;
        to.rest_m = Vec3f(model_->hexels.centre_m(to.hexel));
        to.world_m = Vec3f(from->world[0], from->world[1], from->world[2]);
        to.bare_gap_m = from->bare_gap;
        to.distance_m = from->distance;
        to.outward = Vec3f(from->outward[0], from->outward[1], from->outward[2]);
    }
}

}  // namespace calot::gpu
