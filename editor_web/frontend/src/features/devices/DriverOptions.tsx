/** The options of a driver by its JSON Schema: what is set, and what may be set. They are changed in the document. */
import { Table, Text } from '@mantine/core'
import type { DeviceDetails } from '../../api/types'
import { driverOptions } from '../../document/devices'

export function DriverOptions({ details }: { readonly details: DeviceDetails }) {
  const options = driverOptions(details)
  if (options.length === 0) return null
  return (
    <Table withTableBorder tabularNums verticalSpacing={3} aria-label={`Options of ${details.driver}`}>
      <Table.Thead>
        <Table.Tr>
          <Table.Th>Option</Table.Th>
          <Table.Th>Value</Table.Th>
          <Table.Th>Default</Table.Th>
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {options.map((option) => (
          <Table.Tr key={option.name}>
            <Table.Td>
              {option.name}
              <Text size="xs" c="dimmed">
                {[option.description, option.range].filter(Boolean).join('; ')}
              </Text>
            </Table.Td>
            <Table.Td fw={option.isSet ? 600 : 400} style={{ overflowWrap: 'anywhere' }}>
              {option.value} {option.value && option.unit}
            </Table.Td>
            <Table.Td>
              {option.preset || 'required'} {option.preset && option.unit}
            </Table.Td>
          </Table.Tr>
        ))}
      </Table.Tbody>
    </Table>
  )
}
