/** The children of a container whose order means something, to be moved up and down. */
import { Group, List, Text } from '@mantine/core'
import { IconArrowDown, IconArrowUp } from '@tabler/icons-react'
import type { EditNode } from '../../document/editing/model'
import { choose, focusNode, reorder } from './actions'
import { LinkButton } from './FormParts'
import { Section } from './Section'
import { Tool } from './Tool'

export function OrderForm({ node }: { node: EditNode }) {
  return (
    <Section title="Order of the children">
      <List type="ordered" size="sm">
        {node.children.map((child, index) => (
          <List.Item key={child.name}>
            {child.role && (
              <Text span size="xs" c="dimmed" mr={6}>
                {child.role}
              </Text>
            )}
            <LinkButton
              onPress={() => {
                choose([child.path])
                focusNode(child.path)
              }}
            >
              {child.name}
            </LinkButton>
            <Group display="inline-flex" gap={0} ml={4} style={{ verticalAlign: 'middle' }}>
              <Tool isSmall label={`Move ${child.name} up`} isDisabled={index === 0} onPress={() => void reorder(node, child.name, -1)}>
                <IconArrowUp size={13} aria-hidden />
              </Tool>
              <Tool
                isSmall
                label={`Move ${child.name} down`}
                isDisabled={index === node.children.length - 1}
                onPress={() => void reorder(node, child.name, 1)}
              >
                <IconArrowDown size={13} aria-hidden />
              </Tool>
            </Group>
          </List.Item>
        ))}
      </List>
    </Section>
  )
}
