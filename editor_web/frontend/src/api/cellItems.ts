/** What the open cell consists of. */
import { call } from './client'
import type { CellItems } from './types'

export function cellItems(): Promise<CellItems> {
  return call<CellItems>('/cell/items')
}
