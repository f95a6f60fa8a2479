# The commands that CI runs, by the names that it has for them. `just` lists them; `just ci` runs all.

_default:
    @just --list --unsorted

# Everything that must hold before a change lands.
ci:
    .ci/run

# Checks that the code is as rustfmt sets it.
format:
    .ci/run format

# Draws the README's first picture into target/quickstart.png.
quickstart:
    .ci/run quickstart

# Runs the whole suite on Vulkan, and the documentation's examples.
test:
    .ci/run test

# Runs the suite with the six faces of a lamp in one pass.
multiview:
    .ci/run multiview

# Runs the suite on OpenGL.
opengl:
    .ci/run opengl

# Compares what lookups cost with the table.
lookup:
    .ci/run lookup

# Runs the examples.
examples:
    .ci/run examples

# Compiles every shader in headless Chromium.
browser:
    .ci/run browser

# Runs the viewer's own tests.
viewer:
    .ci/run viewer

# Runs the integrations into other engines.
guests:
    .ci/run guests

# Runs clippy over everything.
lints:
    .ci/run lints

# Builds the documentation.
docs:
    .ci/run docs

# Checks what the package holds.
package:
    .ci/run package

# Runs everything that is tested in headless Chromium; before a release.
browser-tests:
    .ci/browser-tests

# Runs what takes too long for every change; before a release.
release:
    .ci/release
