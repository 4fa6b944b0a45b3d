# Cistula built and tested on Debian 13, from the source tree's root:
#     docker build -f cmake/docker/debian-13.Dockerfile -t cistula . && docker run --rm cistula render --help
FROM debian:13
COPY . /cistula
WORKDIR /cistula
RUN tests/try-system --quick
ENV PATH="/cistula/build/release/bin:$PATH"
CMD ["bash"]
