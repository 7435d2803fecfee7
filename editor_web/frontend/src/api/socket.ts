/** Websockets of the server that the page came from. */

/** Open the one at an address below `/api/v1`. */
export function openSocket(path: string): WebSocket {
  return new WebSocket(`${location.origin.replace(/^http/, 'ws')}/api/v1${path}`)
}
