// CGAL's straight skeleton, timed as users call it. In: a file with one polygon per line (number of vertices, then
// x y of each), the least number of rounds and the time to spend. Out: one line per polygon and round, as it ends:
// seconds, greatest time of a node (-1 without a skeleton).
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/create_straight_skeleton_2.h>
#include <CGAL/version.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polygon = CGAL::Polygon_2<Kernel>;
using Clock = std::chrono::steady_clock;

static double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

int main(int count, char** arguments) {
    if (count == 2 && std::strcmp(arguments[1], "--version") == 0) {
        std::puts(CGAL_VERSION_STR);
        return 0;
    }
    if (count != 4) {
        std::fputs("usage: straight_skeleton FILE ROUNDS SECONDS\n", stderr);
        return 2;
    }
    std::ifstream file(arguments[1]);
    const int rounds = std::atoi(arguments[2]);
    const double seconds = std::atof(arguments[3]);
    std::vector<Polygon> polygons;
    for (std::size_t corners; file >> corners;) {
        Polygon polygon;
        for (std::size_t i = 0; i < corners; ++i) {
            double x, y;
            file >> x >> y;
            polygon.push_back(Kernel::Point_2(x, y));
        }
        polygons.push_back(polygon);
    }
    const Clock::time_point begin = Clock::now();
    for (int round = 0; round < rounds || since(begin) < seconds; ++round) {
        for (const Polygon& polygon : polygons) {
            const Clock::time_point start = Clock::now();
            const auto skeleton = CGAL::create_interior_straight_skeleton_2(polygon, Kernel());
            const double taken = since(start);
            double height = skeleton ? 0.0 : -1.0;
            if (skeleton) {
                for (auto v = skeleton->vertices_begin(); v != skeleton->vertices_end(); ++v) {
                    height = std::max(height, CGAL::to_double(v->time()));
                }
            }
            std::printf("%.9f %.17g\n", taken, height);
        }
        std::fflush(stdout);
    }
}
