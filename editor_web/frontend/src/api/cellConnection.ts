/** Whether the world and the devices of the cell are there, and connecting them again. */
import { create } from 'zustand'
import { call, post, ServerError } from './client'
import type { CellConnection } from './types'

const CONNECTED: CellConnection = { connected: true, reason: '' }

export const useCellConnection = create<CellConnection>(() => CONNECTED)

/** Ask the server; one that is not asked about its cell, or does not answer now, changes nothing. */
export async function loadCellConnection(): Promise<void> {
  try {
    useCellConnection.setState(await call<CellConnection>('/cell/connection'))
  } catch (error) {
    // The page says by other means that nobody answers, or that it is logged out.
    if (error instanceof ServerError && error.status === 404) useCellConnection.setState(CONNECTED)
  }
}

/** Connect what was lost; a refusal is a ServerError. */
export async function connectCell(): Promise<void> {
  await post<unknown>('/cell/connect', {})
  await loadCellConnection()
}
