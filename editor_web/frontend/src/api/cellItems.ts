/** What the open cell consists of, and the drivers of its devices. */
import { queryOptions } from '@tanstack/react-query'
import { call } from './client'
import { queryKeys } from './queryKeys'
import type { CellItems, DeviceDetails } from './types'

export function cellItemsQuery() {
  return queryOptions({ queryKey: queryKeys.cellItems, queryFn: () => call<CellItems>('/cell/items') })
}

/** The devices with a driver: what it can do, and its options; `hasAny` as the session tells. */
export function cellDevicesQuery(hasAny: boolean) {
  return queryOptions({ queryKey: queryKeys.cellDevices, queryFn: () => call<readonly DeviceDetails[]>('/cell/devices'), enabled: hasAny })
}
