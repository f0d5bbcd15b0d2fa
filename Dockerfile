# thermograsp without a display, with everything compiled and built ahead, for any processor of the architecture that it is
# built on:
#   docker build -t thermograsp .
#   docker run --rm thermograsp thermograsp grasp --material glass --seconds 3
FROM python:3.11-slim AS build
COPY . /source
RUN pip wheel --no-cache-dir --no-deps --wheel-dir /wheels /source

FROM python:3.11-slim
# OpenGL in software, for pictures.
RUN apt-get update \
    && apt-get install -y --no-install-recommends libegl1 libegl-mesa0 libgl1-mesa-dri libopengl0 \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /wheels /wheels
RUN pip install --no-cache-dir /wheels/*.whl

# numba's code for a generic processor, else it is compiled again on every other one. These hold at run time too.
ENV MUJOCO_GL=egl \
    NUMBA_CPU_NAME=generic \
    NUMBA_CACHE_DIR=/var/cache/thermograsp/compiled \
    THERMOGRASP_CACHE=/var/cache/thermograsp/networks
# Any user may run the image, and keep what it lacks.
RUN thermograsp warmup && chmod -R a+rwX /var/cache/thermograsp

WORKDIR /work
CMD ["thermograsp", "--help"]
