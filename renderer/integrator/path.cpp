#include "renderer/integrator/path.h"

#include "renderer/integrator/folded_bsdf.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rapport {
namespace {

constexpr int kRouletteDepth = 3; ///< scattering events before Russian roulette
/// Directions of lights that one is picked from at a vertex. Seconds × variance, with this number
/// changed, is 0.77, 0.83 and 0.85 of that of one direction, for 2, 3 and 4, of the picture of
/// scenes/quickstart.pbrt, which has lamps; and 0.98, 1.03 and 1.12 of that of the dress in satin
/// and plain weave under two photographed skies (tests/bench/sampling_bench.cpp, 64 samples, in the
/// geometric mean).
constexpr int kCandidates = 2;

float mean(const Rgb& c) { return (c.r + c.g + c.b) * (1 / 3.0f); }

constexpr float kOnlyWay = std::numeric_limits<float>::infinity();

/// Weight of a direction that was found with density `chosen`, and could have been with `other`; 1
/// where the chosen is infinite.
float balance(float chosen, float other) { return 1 / (1 + other / chosen); }

/// The last scattering event of the path, or the camera.
struct Scattering {
    glm::vec3 position;
    float pdf; ///< of the direction it took; kOnlyWay where no light sample could have found it,
               ///< as from a mirror
};

/// Whether a direction lies on the same side by the geometry as by the shading frame. Where it
/// does not, light would leak through a surface that is smooth only in its normals; FoldedBsdf has
/// none there, except by rounding.
bool sides_agree(const SurfacePoint& point, const glm::vec3& world, const glm::vec3& local) {
    return glm::dot(world, point.geometric_normal) * local.z > 0;
}

/// Russian roulette: whether a path goes on, then weighted for those that do not.
bool survives(Rgb& throughput, Sampler& sampler) {
    const float survival = std::min(1.0f, std::max({throughput.r, throughput.g, throughput.b}));
    if (!(sampler.next_1d() < survival))
        return false;
    throughput /= survival;
    return true;
}

/// How often a path goes straight on where the share `through` of the light does, and the share
/// `scattered` is: by these shares, so that either way the path carries the same on.
float chance_to_pass(float through, float scattered) {
    return through > 0 ? through / (through + scattered) : 0;
}

/// What a sampled direction of a sampled light adds if nothing stands between, weighted against
/// finding it by the BSDF.
struct Candidate {
    Rgb added{0};
    const Light* light = nullptr;
    glm::vec3 direction{0};
    float distance = 0;
};

Candidate light_candidate(const Scene::LightChoice& choice, int of, const SurfacePoint& point,
                          const Rgb& reflectance, const Frame& frame, const FoldedBsdf& bsdf,
                          float chance, const glm::vec2& u) {
    const auto light = choice.light->sample(point.position, u);
    if (!light)
        return {};
    const glm::vec3 local = frame.to_local(light->direction);
    if (!sides_agree(point, light->direction, local))
        return {};
    const auto [scattered, pdf] = bsdf.eval_and_pdf(local);
    const Rgb arriving = scattered * reflectance * light->radiance;
    if (light->delta)
        return {arriving / choice.probability, choice.light, light->direction, light->distance};
    const float density = choice.probability * light->pdf;
    const float weight = balance(static_cast<float>(of) * density, chance * pdf);
    return {arriving * (weight / density), choice.light, light->direction, light->distance};
}

/// Length of a shadow ray: it stops short of the light by what rounding may make of the place of
/// either end.
float shadow_length(const glm::vec3& origin, const SurfacePoint& point, const Candidate& to) {
    const float distance = to.distance - glm::dot(origin - point.position, to.direction);
    if (std::isinf(distance))
        return distance;
    const float reach = largest_coordinate(point.position + to.distance * to.direction);
    return distance - 16 * std::numeric_limits<float>::epsilon() * std::max(point.reach, reach);
}

/// Light scattered towards the eye out of one of some sampled directions of the lights, picked in
/// proportion to what it adds if nothing stands between (resampled importance sampling: Talbot et
/// al. 2005): to ask the table is cheaper than to trace a ray. The path will look for the same by
/// the BSDF with probability `chance`.
///
/// The candidates are one point of every stratum of the lights' shares and a shifted lattice (R2)
/// in the space of directions; each is as likely as if it were alone, which is all that is needed.
/// Counts the ray that it traces among `rays`.
Rgb direct_light(const Scene& scene, const SurfacePoint& point, const Rgb& reflectance,
                 const Frame& frame, const FoldedBsdf& bsdf, float chance, Sampler& sampler,
                 uint32_t& rays) {
    const auto first = scene.choose_light(0);
    if (!first)
        return Rgb(0);
    const bool alike = first->probability == 1 && first->light->is_delta();
    const int count = alike ? 1 : kCandidates;
    const float place_in_stratum = sampler.next_1d();
    const glm::vec2 shift = sampler.next_2d();
    const glm::vec2 step(0.7548776662f, 0.5698402910f);
    float pick = sampler.next_1d();
    Candidate picked;
    float total = 0, of_picked = 0;
    for (int i = 0; i < count; ++i) {
        const auto number = static_cast<float>(i);
        const auto choice =
            scene.choose_light((number + place_in_stratum) / static_cast<float>(count));
        const Candidate candidate = light_candidate(*choice, count, point, reflectance, frame, bsdf,
                                                    chance, glm::fract(shift + number * step));
        const float weight = mean(candidate.added);
        if (!std::isfinite(weight)) // to be seen, not to be picked or not
            return candidate.added;
        if (weight == 0)
            continue;
        total += weight;
        const float share = weight / total; // one number picks: what is left of it is even again
        if (pick < share) {
            picked = candidate;
            of_picked = weight;
            pick /= share;
        } else
            pick = (pick - share) / (1 - share);
    }
    if (total == 0)
        return Rgb(0);
    ++rays;
    const glm::vec3 origin = offset_origin(point, picked.direction);
    const Rgb passed = scene.transmittance(origin, picked.direction,
                                           shadow_length(origin, point, picked), *picked.light);
    return picked.added * passed * (total / (of_picked * static_cast<float>(count)));
}

Rgb escaped_radiance(const Scene& scene, const glm::vec3& direction, const Scattering& last) {
    Rgb radiance(0);
    for (const auto& [light, probability] : scene.distant_lights()) {
        const auto [escaped, pdf] = light->escaped(direction);
        if (escaped != Rgb(0))
            radiance += escaped * balance(last.pdf, kCandidates * probability * pdf);
    }
    return radiance;
}

Rgb emitted_radiance(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction,
                     const Scattering& last) {
    const AreaLight* const light = point.surface->area_light.get();
    if (!light)
        return Rgb(0);
    const Rgb emitted = light->emitted(point.geometric_normal, -direction);
    if (emitted == Rgb(0) || last.pdf == kOnlyWay)
        return emitted;
    const float density = kCandidates * scene.choice_probability(*light) *
                          light->pdf(point.position - last.position, point.geometric_normal);
    return emitted * balance(last.pdf, density);
}

} // namespace

PathResult trace_path(const Scene& scene, kernel::Ray ray, std::optional<SurfacePoint> point,
                      Sampler& sampler, std::vector<PathVertex>* vertices) {
    PathResult path;
    Rgb throughput(1);
    Scattering last{ray.org, kOnlyWay};
    int depth = 0;
    for (int layers = 0; layers <= Scene::kMaxLayers; point = scene.intersect(ray)) {
        ++path.rays;
        if (!point) {
            path.radiance += throughput * escaped_radiance(scene, ray.dir, last);
            break;
        }
        if (vertices)
            vertices->push_back({*point, throughput});
        const bool first = depth == 0 && layers == 0;
        path.radiance += throughput * emitted_radiance(scene, *point, ray.dir, last);

        if (const auto& fibres = point->surface->fibres) {
            const bool scatters = depth < scene.settings.max_depth;
            CounterRng rng = sampler.stream();
            const auto passage = scatters ? fibres->follow(point->position, ray.dir, rng)
                                          : fibres->pass(point->position, ray.dir);
            if (!passage) {
                path.cut += scatters ? 0 : mean(throughput);
                break;
            }
            if (passage->scattered) {
                if (first)
                    path.albedo = passage->weight;
                throughput *= passage->weight;
                last = {passage->position, kOnlyWay};
                if (++depth > kRouletteDepth && !survives(throughput, sampler))
                    break;
            }
            ray = {offset_origin(*point, *passage), passage->direction};
            layers = passage->scattered ? 0 : layers + 1;
            continue;
        }

        const Frame frame = point->frame_towards(-ray.dir);
        const glm::vec3 eye = frame.to_local(-ray.dir);
        const Bsdf& material = *point->surface->material;
        const float opacity = point->opacity;
        const Rgb reflectance = opacity * point->reflectance();
        const bool scatters = depth < scene.settings.max_depth;
        const auto [let_through, albedo] = material.shares(eye);
        const Rgb unscattered = 1 - opacity + opacity * let_through;
        const float through = mean(unscattered);
        if (first)
            path.albedo = albedo * reflectance;
        if (!scatters) // even if the unscattered light goes on
            path.cut += mean(throughput * albedo * reflectance);
        const float pass = chance_to_pass(through, scatters ? opacity * mean(albedo) : 0);
        const FoldedBsdf bsdf(material, eye, frame.to_local(point->geometric_normal));
        if (scatters && pass < 1)
            path.radiance += throughput * direct_light(scene, *point, reflectance, frame, bsdf,
                                                       1 - pass, sampler, path.rays);
        if (pass > 0 && sampler.next_1d() < pass) {
            throughput *= unscattered / pass;
            ray = {offset_origin(*point, ray.dir), ray.dir};
            ++layers;
            continue;
        }
        if (!scatters)
            break;
        ++depth;
        throughput /= 1 - pass;

        const float choice = sampler.next_1d();
        const auto sample = bsdf.sample(choice, sampler.next_2d());
        if (!sample)
            break;
        const glm::vec3 direction = glm::normalize(frame.to_world(sample->light));
        if (!sides_agree(*point, direction, sample->light))
            break;
        throughput *= sample->weight * reflectance;
        if (throughput == Rgb(0) || (depth > kRouletteDepth && !survives(throughput, sampler)))
            break;
        last = Scattering{point->position, sample->pdf * (1 - pass)};
        ray = {offset_origin(*point, direction), direction};
        layers = 0;
    }
    return path;
}

} // namespace rapport
