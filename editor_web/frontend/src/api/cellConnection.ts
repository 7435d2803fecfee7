/** Whether the world and the devices of the cell are there, and connecting them again. */
import { queryOptions } from '@tanstack/react-query'
import { call, post, ServerError } from './client'
import { queryKeys } from './queryKeys'
import type { CellConnection } from './types'

export const CONNECTED: CellConnection = { connected: true, reason: '' }

export function cellConnectionQuery() {
  return queryOptions({ queryKey: queryKeys.cellConnection, queryFn: readConnection })
}

/** A server that is not asked about its cell has nothing to lose. */
async function readConnection(): Promise<CellConnection> {
  try {
    return await call<CellConnection>('/cell/connection')
  } catch (error) {
    if (error instanceof ServerError && error.status === 404) return CONNECTED
    throw error
  }
}

/** Connect what was lost; a refusal is a ServerError. */
export function connectCell(): Promise<unknown> {
  return post<unknown>('/cell/connect', {})
}
