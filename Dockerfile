# idc in a container: docs/CI.md. Each step is one of assets/ci/container_steps, so that it can be tried without an engine.
FROM rust:1.95-slim-bookworm AS build
COPY . /source
RUN /source/assets/ci/container_steps build /out

# The same release of Debian: its C library is the one that was linked.
FROM debian:bookworm-slim
COPY --from=build /out/ /usr/local/
RUN --mount=type=bind,source=assets/ci,target=/mnt /mnt/container_steps install /
USER 10001:10001
WORKDIR /work
ENTRYPOINT ["idc"]
CMD ["--help"]
