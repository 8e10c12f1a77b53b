// The field of the device against the host's, at equal residual: conductances, potential, heat, stray current.

#include "calot/base/random.h"
#include "calot/gpu/field.h"
#include "calot/validation/electric_rig.h"
#include "gpu/rig.h"

namespace calot::gpu {
namespace {

/// A rig of the host, and the same on a device.
struct Fields {
    electric::Rig host;
    std::shared_ptr<Device> device = test_device();
    tissue::State state;
    tissue::Exchange exchange;
    Arrays arrays;
    Field field;

    explicit Fields(electric::Rig rig)
        : host(std::move(rig)), state(host.state), arrays(*device, host.model), field(device, host.model, arrays) {}

    /// A whole solve on both, from the same state.
    void solve() {
        state = host.state;
        exchange.near = host.exchange.near;
        arrays.upload(*device, state);
        field.upload(state);
        host.solve();
        field.solve_now(host.model, state, exchange, host.input);
        field.download(state);
    }
    /// Largest difference of two arrays over the largest value.
    static double difference(const Array<float>& a, const Array<float>& b) {
        double most = 0.0, largest = 0.0;
        for (std::size_t k = 0; k < b.size(); ++k) {
            most = std::max(most, std::abs(static_cast<double>(a[k]) - static_cast<double>(b[k])));
            largest = std::max(largest, std::abs(static_cast<double>(b[k])));
        }
        return most / largest;
    }
    static void expect_share(double a, double b, double share, const char* what) {
        EXPECT_NEAR(a, b, share * std::abs(b)) << what;
    }
    void expect_alike(double share) {
        const tissue::FieldState &a = state.field, &b = host.state.field;
        ASSERT_EQ(b.solved, 1);
        EXPECT_EQ(a.solved, 1);
        EXPECT_EQ(field.iterations(), host.work->iterations);
        EXPECT_EQ(a.contacts, b.contacts);
        EXPECT_EQ(a.arcs, b.arcs);
        expect_share(a.residual, b.residual, 0.02, "residual");
        expect_share(a.tissue_S, b.tissue_S, share, "tissue");
        expect_share(a.elsewhere_S, b.elsewhere_S, share, "elsewhere");
        expect_share(a.wire_S, b.wire_S, share, "wire");
        EXPECT_LT(a.imbalance, 1e-5);
        EXPECT_LT(difference(state.potential, host.state.potential), share);
        EXPECT_LT(difference(state.joule_S_per_m3, host.state.joule_S_per_m3), share);
        for (std::size_t m = 0; m < tissue::kStrayMaterials; ++m) {
            expect_share(state.stray_S[m], host.state.stray_S[m], share, "stray current");
            expect_share(state.stray_density_S_per_m2[m], host.state.stray_density_S_per_m2[m], share, "density");
        }
        EXPECT_EQ(state.field_low, host.state.field_low);
        expect_share(state.generator.voltage_V, host.state.generator.voltage_V, share, "voltage");
        expect_share(exchange.joule.total_W, host.exchange.joule.total_W, share, "heat");
    }
};

TEST(GpuField, AHeldBlockIsTheHosts) {
    for (const double residual : {1e-2, 1e-5}) {
        Fields fields(electric::held_rig(residual));
        fields.solve();
        fields.expect_alike(1e-4);
    }
}

TEST(GpuField, ADiscIsTheHosts) {
    for (const int window : {16, 27, 32, 48}) {
        Fields fields(electric::disc_rig(window, 3.0, 0.1, 1e-3));
        fields.solve();
        fields.expect_alike(1e-4);
    }
}

TEST(GpuField, CharOnTheWireAndANearReturn) {
    electric::Rig rig = electric::disc_rig(32, 2.0, 0.1, 1e-3);
    rig.state.tip.char_kg = 2e-7;
    rig.model.electric.return_placed = true;
    rig.model.electric.return_m = rig.model.hexels.centre_m(rig.exchange.near[0].hexel) - Vec3(0.05, 0.0, 0.0);
    Fields fields(std::move(rig));
    fields.solve();
    fields.expect_alike(1e-4);
}

// Holes, hot, boiling and dry hexels, several tissues; contacts and arcs; then a contact that has moved on, from the
// last potential.
TEST(GpuField, RandomStatesAreTheHosts) {
    for (const int window : {32, 40}) {
        tissue::Model model = tissue::sample(anatomy::make_block({.size_m = Vec3(0.0312, 0.0264, 0.0192)}), {});
        model.electric.window_cells = window;
        model.electric.relative_residual = 1e-3;
        Random random(5);
        for (std::int64_t hexel = model.hexels.first; hexel < model.hexels.last; ++hexel)
            if (model.hexel_initial.test(hexel) && random.uniform() < 0.3)
                model.hexel_material[static_cast<std::size_t>(hexel)] =
                    static_cast<tissue::MaterialIndex>(1 + static_cast<int>(random.uniform(0.0, 4.0)));
        electric::Rig rig(std::move(model));
        for (std::int64_t hexel = rig.model.hexels.first; hexel < rig.model.hexels.last; ++hexel) {
            const auto h = static_cast<std::size_t>(hexel);
            if (random.uniform() < 0.2 && rig.state.hexel_present.test(hexel)) rig.state.hexel_present.clear(hexel);
            if (random.uniform() < 0.3) rig.state.enthalpy_J_per_m3[h] = static_cast<float>(random.uniform(0.0, 3e8));
            if (random.uniform() < 0.1) rig.state.water_kg_per_m3[h] *= static_cast<float>(random.uniform());
            if (random.uniform() < 0.1) rig.state.water_kg_per_m3[h] = 0.0f;
        }
        for (int x = 20; x < 30; ++x)
            for (int z = 33; z < 36; ++z)
                if (rig.state.hexel_present.test(rig.model.hexels.index(x, 22, z)))
                    rig.touch({x, 22, z}, z == 35 ? 1e-4f : 0.0f);
        for (tissue::NearHexel& near : rig.exchange.near) near.outward = Vec3f(0.0f, 0.6f, 0.8f);
        Fields fields(std::move(rig));
        fields.solve();
        fields.expect_alike(1e-3);
        EXPECT_GT(fields.state.field.arcs, 0);
        EXPECT_GT(fields.state.field.contacts, 0);
        fields.host.exchange.near.resize(9);
        for (int x = 34; x < 40; ++x) fields.host.touch({x, 24, 34});
        fields.solve();
        fields.expect_alike(1e-3);
    }
}

// The parts of a frame give what the host's give, tick by tick, while the contact walks.
TEST(GpuField, AFrameIsTheHosts) {
    Fields fields(electric::held_rig(1e-2));
    fields.arrays.upload(*fields.device, fields.state);
    fields.field.upload(fields.state);
    for (int tick = 0; tick < 48; ++tick) {
        if (tick % 8 == 0)
            for (tissue::NearHexel& near : fields.host.exchange.near) near.hexel += fields.host.model.hexels.stride.x;
        if (tick == 35) fields.host.exchange.near.clear();
        fields.host.input.pedal = tick < 20;
        fields.exchange.near = fields.host.exchange.near;
        electric::step_field(fields.host.model, fields.host.state, fields.host.exchange, fields.host.input,
                             *fields.host.work);
        fields.field.step(fields.host.model, fields.state, fields.exchange, fields.host.input);
        const tissue::State &a = fields.state, &b = fields.host.state;
        ASSERT_EQ(a.field.solved, b.field.solved) << tick;
        ASSERT_EQ(a.field.solved, tick >= 7 && tick < 35 ? 1 : 0) << tick;
        ASSERT_NEAR(a.generator.impedance_Ohm, b.generator.impedance_Ohm, 1e-3 * b.generator.impedance_Ohm) << tick;
        ASSERT_NEAR(fields.exchange.joule.total_W, fields.host.exchange.joule.total_W,
                    1e-3 * fields.host.exchange.joule.total_W)
            << tick;
        ASSERT_EQ(fields.exchange.joule.size, fields.host.exchange.joule.size) << tick;
        ++fields.state.tick;
        ++fields.host.state.tick;
    }
    EXPECT_GT(fields.host.state.stray.energy_J[1], 0.0);
}

TEST(GpuField, IsDeterministic) {
    std::array<Array<float>, 2> heat;
    for (Array<float>& one : heat) {
        Fields fields(electric::held_rig(1e-4));
        fields.solve();
        one = fields.state.joule_S_per_m3;
    }
    EXPECT_EQ(heat[0], heat[1]);
}

}  // namespace
}  // namespace calot::gpu
