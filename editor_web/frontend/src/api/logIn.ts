/** Logging in again from within the page. */
import { api, reach } from './client'

const PROBLEMS = new Map([
  [401, 'That token is not valid for this server.'],
  [429, 'Too many wrong tokens. Wait some seconds, then try again.'],
])

/** Exchange a token for a session; returns why that was refused, empty when it was not. */
export async function logIn(token: string): Promise<string> {
  const response = await reach('/login', { method: 'POST', body: new URLSearchParams({ token }) })
  if (!response.ok) return PROBLEMS.get(response.status) ?? `The server refused it: ${response.status} ${response.statusText}`
  await api.session()
  return ''
}
