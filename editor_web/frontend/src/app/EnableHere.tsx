/** Enables a real device from the recovery guide. */
import { cellDevicesQuery } from '../api/cellItems'
import { useAnswer } from '../api/queryClient'
import type { DeviceRecovery } from '../api/types'
import { EnableButton } from '../features/devices/EnableButton'

export function EnableHere({ device }: { readonly device: DeviceRecovery }) {
  const { value: devices } = useAnswer(cellDevicesQuery(true))
  const details = devices?.find((each) => each.address === device.name)
  return <EnableButton address={device.name} state={device} enabling={details?.enabling ?? ''} />
}
