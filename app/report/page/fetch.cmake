# SPDX-License-Identifier: AGPL-3.0-or-later
# Fetch the JavaScript packages of the page, once, at the versions and checksums of the lock file.
# cmake -DNPM=... -DSOURCE=app/report/page -DWORK=<build folder> -P fetch.cmake
file(MAKE_DIRECTORY ${WORK})
file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${WORK})
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(failed)
  message(FATAL_ERROR "${output}\n"
    "The JavaScript packages of the report page (uplot, esbuild) could not be fetched.\n"
    "Remedy: connect this machine to the npm registry (or set its mirror with `npm config set registry`) "
    "and build again; or run `npm ci --ignore-scripts` beside a copy of app/report/page/package-lock.json "
    "on another machine and configure with -DPALPATE_PAGE_MODULES=/path/to/node_modules")
endif()
