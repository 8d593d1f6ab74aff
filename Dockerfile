# The program and the libraries that it loads, and nothing else: docs/operations.md.
FROM debian:bookworm-slim AS build
RUN apt-get update \
    && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
        g++ cmake ninja-build pkg-config ca-certificates npm \
        libeigen3-dev libcpp-httplib-dev nlohmann-json3-dev libspdlog-dev libcli11-dev zlib1g-dev libssl-dev \
        prometheus-cpp-dev \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /vines

# The packages as the checkout already has them, if they are there in the right versions (so the build works without npm's registry);
# else by the lock file.
COPY web web
RUN cd web && { npm ls --omit=dev >/dev/null 2>&1 || npm ci --omit=dev --no-audit --no-fund; }

COPY CMakeLists.txt ./
COPY docs docs
COPY src src
COPY clients/report clients/report
COPY packaging packaging
# Here is no git to ask for it.
ARG VINES_COMMIT=
RUN cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DVINES_TESTS=OFF -DVINES_COMMIT="$VINES_COMMIT" \
    && cmake --build build --target vines \
    && strip build/vines

# The program and the libraries it loads, each at the path where the loader looks for it: Debian has no static archive
# for some of them. All of one age, so that two builds give the same bytes.
ARG SOURCE_DATE_EPOCH
RUN mkdir /image \
    && cp build/vines /image/ \
    && ldd build/vines >/tmp/libraries && ! grep 'not found' /tmp/libraries \
    && grep -o '/[^ ]*' /tmp/libraries | xargs cp -L --parents -t /image \
    && find /image -exec touch -d "@${SOURCE_DATE_EPOCH:-0}" {} +

# Nothing but the program: no shell or package manager to attack or to update.
FROM scratch
COPY --from=build /image /
USER 65532:65532
ENV VINES_HOST=0.0.0.0
EXPOSE 8080
HEALTHCHECK --interval=30s --timeout=5s CMD ["/vines", "healthcheck"]
ENTRYPOINT ["/vines"]
CMD ["serve"]
