#include "calot/render/shaders.h"

namespace calot::render::shaders {

// Must match FrameUniforms in frame.h.
const char* const kFrame = R"(
layout(std140) uniform Frame {
    mat4 u_view_projection;
    mat4 u_view;
    vec4 u_eye;          // position, time [s]
    vec4 u_axis;         // where the scope looks, distance at which exposure is right [m]
    vec4 u_light[2];     // position, share of the light
    vec4 u_spark;        // position, strength
    vec4 u_projection;   // tan of half angles x, y; near, far [m]
    vec4 u_round;        // radii of the round image in NDC x, y; barrel distortion; pulse 0..1
    vec4 u_pixels;       // size of the scene target, 1 / size
    vec4 u_capsule_a[CAPSULES]; // end, radius
    vec4 u_capsule_b[CAPSULES]; // end, 1 = bare
    vec4 u_lens;         // fog, smear 0..1, pattern
    ivec4 u_counts;      // map (Paint), frame
};

// Distance along the axis from a depth value [m].
float axial_m(float depth) {
    float near = u_projection.z, far = u_projection.w;
    return near * far / (far - depth * (far - near));
}

#ifdef HDR
vec3 encode(vec3 colour) { return min(colour, vec3(200.0)); }
vec3 decode(vec3 colour) { return colour; }
#else
vec3 encode(vec3 colour) { return sqrt(min(colour, vec3(4.0)) * 0.25); }
vec3 decode(vec3 colour) { return 4.0 * colour * colour; }
#endif
)";

const char* const kLight = R"(
struct Material {
    vec3 albedo;
    vec3 normal;       // of the tissue under the film of fluid
    vec3 coat_normal;  // of the film
    float rough;
    float specular;    // reflectance at normal incidence
    float coat;        // how much film there is, 0..1
    float coat_rough;
    vec3 wrap;         // light that creeps past the terminator, by colour
    float occlusion;   // 1 = open
};

// Light that a capsule lets through between a point and a light: soft by how far away the capsule is.
float capsule_light(vec3 p, vec3 to_light, vec3 a, vec3 b, float radius) {
    vec3 e = b - a, r = p - a;
    float dd = dot(to_light, to_light), ee = dot(e, e), de = dot(to_light, e);
    float dr = dot(to_light, r), er = dot(e, r);
    float s = clamp((de * er - dr * ee) / max(dd * ee - de * de, 1e-14), 0.0, 1.0);
    float t = clamp((de * s + er) / ee, 0.0, 1.0);
    s = clamp((de * t - dr) / dd, 0.0, 1.0);
    float gap = length(r + s * to_light - t * e) - radius;
    float soft = 0.00015 + 0.0022 * s / max(1.0 - s, 0.05);   // penumbra of a light about 2 mm wide
    return s < 0.002 ? 1.0 : smoothstep(-0.6 * soft, soft, gap);
}

// What capsules close to a point hide of its surroundings.
float capsule_openness(vec3 p, vec3 n, vec3 a, vec3 b, float radius) {
    vec3 e = b - a;
    vec3 d = a + clamp(dot(p - a, e) / dot(e, e), 0.0, 1.0) * e - p;
    float far = length(d);
    float solid = radius * radius / max(far * far, radius * radius);
    return 1.0 - 0.75 * solid * clamp(0.35 + 0.65 * dot(n, d) / max(far, 1e-6), 0.0, 1.0);
}

float ggx(float nh, float rough) {
    float a2 = rough * rough;
    a2 *= a2;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    return a2 / (3.14159265 * d * d);
}

// Falls off with the square of the distance, tamed close by as the camera's exposure does.
float scope_falloff(float d2) { return 2.0 / (1.0 + d2 / (u_axis.w * u_axis.w)); }

// The wet cavity, as seen in a mirror: lit tissue ahead, the dark scope behind.
vec3 surroundings(vec3 direction) {
    float ahead = dot(direction, u_axis.xyz);
    vec3 tissue = vec3(0.55, 0.26, 0.17), dark = vec3(0.035, 0.018, 0.014);
    return mix(dark, tissue, smoothstep(-0.5, 0.9, ahead));
}

vec3 light_material(Material m, vec3 p, bool shadowed) {
    vec3 view = normalize(u_eye.xyz - p);
    vec3 sum = vec3(0.0), shine = vec3(0.0);
    float open = m.occlusion;
    if (shadowed)
        for (int k = 0; k < CAPSULES; ++k)
            open *= capsule_openness(p, m.normal, u_capsule_a[k].xyz, u_capsule_b[k].xyz, u_capsule_a[k].w);
    for (int light = 0; light < 2; ++light) {
        vec3 to_light = u_light[light].xyz - p;
        float d2 = dot(to_light, to_light);
        vec3 l = to_light * inversesqrt(d2);
        float aim = clamp(-dot(l, u_axis.xyz), 0.0, 1.0);
        float beam = aim * aim;
        float power = u_light[light].w * beam * beam * beam * scope_falloff(d2);
#if QUALITY > 0
        if (shadowed)
#else
        if (shadowed && light == 0)   // the brighter one; a low tier spares the other's shadow
#endif
            for (int k = 0; k < CAPSULES; ++k)
                power *= capsule_light(p, to_light, u_capsule_a[k].xyz, u_capsule_b[k].xyz, u_capsule_a[k].w);
        vec3 h = normalize(l + view);
        vec3 lambert = clamp((vec3(dot(m.normal, l)) + m.wrap) / (1.0 + m.wrap), 0.0, 1.0);
        sum += power * lambert * lambert;
        // Light and eye are close together: l.h is about 1, so that Fresnel's term stays at normal incidence.
        float base = ggx(clamp(dot(m.normal, h), 0.0, 1.0), m.rough) * m.specular;
        float film = ggx(clamp(dot(m.coat_normal, h), 0.0, 1.0), m.coat_rough) * 0.045 * m.coat;
        shine += power * clamp(dot(m.coat_normal, l), 0.0, 1.0) * (base + film) * 0.25;
    }
    vec3 to_spark = u_spark.xyz - p;
    float spark = u_spark.w * 1.2e-6 / (dot(to_spark, to_spark) + 1.0e-6);
    sum += spark * vec3(1.0, 0.62, 0.32) * clamp(0.4 + 0.6 * dot(m.normal, normalize(to_spark)), 0.0, 1.0);
    // Light that has bounced about the cavity: warm, and gone where surfaces hide each other.
    float facing = clamp(dot(m.normal, view), 0.0, 1.0);
    vec3 bounced = vec3(0.085, 0.052, 0.040) * (0.4 + 0.6 * facing);
    vec3 hidden = open * mix(vec3(1.0), vec3(open), 0.6 * (1.0 - m.albedo));   // colour deepens in creases
    float rim = 1.0 - clamp(dot(m.coat_normal, view), 0.0, 1.0);
    rim = 0.03 + 0.97 * rim * rim * rim * rim * rim;
    vec3 mirrored = surroundings(reflect(-view, m.coat_normal)) * rim * m.coat * 0.5;
    return m.albedo * (sum * mix(vec3(1.0), hidden, 0.75) + bounced * hidden) + shine * (0.3 + 0.7 * open) + mirrored * open;
}
)";

const char* const kMaskVertex = R"(
void main() {
    // A strip around the circle: even vertices on it, odd ones far outside.
    float turn = float(gl_VertexID / 2) * (6.2831853 / 96.0);
    float r = (gl_VertexID & 1) == 0 ? 1.003 : 4.0;
    gl_Position = vec4(r * cos(turn) * u_round.x, r * sin(turn) * u_round.y, -1.0, 1.0);
}
)";

const char* const kDepthFragment = R"(
out vec4 o_colour;
void main() { o_colour = vec4(0.0, 0.0, 0.0, 1.0); }
)";

const char* const kScreenVertex = R"(
out vec2 v_uv;
void main() {
    vec2 corner = vec2(float((gl_VertexID & 1) * 4) - 1.0, float((gl_VertexID & 2) * 2) - 1.0);
    v_uv = 0.5 * corner + 0.5;
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";

}  // namespace calot::render::shaders
